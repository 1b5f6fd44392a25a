// Invariant 4: cost follows change. Snapshots share their tiles with the grid, which copies a tile
// only to change it.

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "mapper_fixture.h"

namespace fiimap {
namespace {

using TileId = std::pair<int, int>;

TileId tileOf(const VoxelIndex& v) { return {v.x() >> kTileShift, v.y() >> kTileShift}; }

/// Where the cells of each tile are in memory.
std::map<TileId, const std::uint64_t*> addresses(const Mapper& mapper) {
  std::map<TileId, const std::uint64_t*> found;
  for (const int slot : mapper.grid().liveSlots()) {
    const VoxelIndex& origin = mapper.grid().tileOrigin(slot);
    found[tileOf(origin)] = mapper.grid().column(Plane::kKnown, origin.x(), origin.y());
  }
  return found;
}

/// A map of 8 x 8 tiles in which all tiles have been seen.
class MapperCostTest : public ::testing::Test {
 protected:
  MapperCostTest() : mapper_(config()) {
    for (int degree = 0; degree < 360; ++degree) {
      const double angle = degree * M_PI / 180.0;
      wide_scan_.points.push_back({static_cast<float>(40.0 * std::cos(angle)),
                                   static_cast<float>(40.0 * std::sin(angle)), 0.0f});
    }
    // Until what it sees stays as it is.
    for (int i = 0; i < 10; ++i) mapper_.integrate(wide_scan_, test::poseAt({0.1, 0.1, 0.1}));
  }

  static MapperConfig config() {
    MapperConfig config = test::smallConfig();
    config.map_mode = MapMode::kFixed;
    config.map_size_x = config.map_size_y = 64.0;
    config.local_update_range_x = config.local_update_range_y = 64.0;
    config.max_ray_length = 100.0;
    return config;
  }

  /// Changes the map and checks that exactly the tiles with changed voxels were copied.
  /// \return how many.
  std::size_t copiedTiles(const std::function<void()>& change) {
    // The old snapshot is held, so that no address is used again.
    const std::shared_ptr<const Snapshot> old_snapshot = mapper_.snapshot();
    const auto old_addresses = addresses(mapper_);
    change();
    const std::shared_ptr<const Snapshot> snapshot = mapper_.snapshot();
    std::set<TileId> copied;
    for (const auto& [tile, address] : addresses(mapper_)) {
      const auto old = old_addresses.find(tile);
      if (old == old_addresses.end() || old->second != address) copied.insert(tile);
    }
    EXPECT_EQ(copied, tilesThatDiffer(*old_snapshot, *snapshot));
    return copied.size();
  }

  std::size_t copiedTiles(const PointScan& scan, const ScanPose& pose) {
    return copiedTiles([&] { mapper_.integrate(scan, pose); });
  }

  static std::set<TileId> tilesThatDiffer(const Snapshot& a, const Snapshot& b) {
    std::set<TileId> tiles;
    const VoxelBox& window = a.window();
    for (int x = window.min.x(); x < window.max.x(); ++x) {
      for (int y = window.min.y(); y < window.max.y(); ++y) {
        for (int z = window.min.z(); z < window.max.z(); ++z) {
          const VoxelIndex v(x, y, z);
          if (a.occupancy(v) != b.occupancy(v) || a.inflation(v) != b.inflation(v)) {
            tiles.insert(tileOf(v));
          }
        }
      }
    }
    return tiles;
  }

  Mapper mapper_;
  PointScan wide_scan_;
  const PointScan kPointAhead{{Eigen::Vector3f(1.0f, 0.0f, 0.0f)}};
};

TEST_F(MapperCostTest, AScanWithoutChangeCopiesNothing) {
  ASSERT_EQ(addresses(mapper_).size(), 64u);
  EXPECT_EQ(copiedTiles(wide_scan_, test::poseAt({0.1, 0.1, 0.1})), 0u);
}

TEST_F(MapperCostTest, ASmallChangeCopiesTheTilesItTouches) {
  // In the middle of a tile; seen three times to become an obstacle.
  const ScanPose pose = test::poseAt({12.1, 12.1, 0.6});
  std::size_t copied = 0;
  for (int i = 0; i < 3; ++i) copied += copiedTiles(kPointAhead, pose);
  EXPECT_EQ(mapper_.snapshot()->occupancy(Eigen::Vector3d(13.1, 12.1, 0.6)), Occupancy::kOccupied);
  EXPECT_GE(copied, 2u);
  EXPECT_LE(copied, 3u);
}

TEST_F(MapperCostTest, InflationAcrossABorderCopiesBothTiles) {
  // Tiles meet at x = 8; the obstacle is the last voxel before it.
  const ScanPose pose = test::poseAt({6.9, 12.1, 0.6});
  std::size_t most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, copiedTiles(kPointAhead, pose));
  EXPECT_EQ(most, 2u);
}

TEST_F(MapperCostTest, AnEditCopiesTheTilesThatItChanges) {
  const VoxelIndex v(50, 50, 2);  // in the middle of a tile
  const auto makeIt = [&](Occupancy state) {
    mapper_.overwrite({{v, v + VoxelIndex(2, 1, 1)}}, state);
  };
  EXPECT_EQ(copiedTiles([&] { makeIt(Occupancy::kOccupied); }), 1u);
  EXPECT_EQ(copiedTiles([&] { makeIt(Occupancy::kOccupied); }), 0u);
  EXPECT_EQ(copiedTiles([&] { makeIt(Occupancy::kUnknown); }), 1u);
  EXPECT_EQ(copiedTiles([&] { makeIt(Occupancy::kUnknown); }), 0u);
}

}  // namespace
}  // namespace fiimap
