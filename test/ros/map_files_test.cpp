// What readMap reads is what saveMap wrote, and what the OctoMap library reads. Damaged files:
// test/faults/file_fault_test.cpp.

#include "fiimap/ros/map_files.h"

#include <octomap/octomap.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../core/effort.h"
#include "../core/oracle.h"

namespace fiimap {
namespace {

namespace fs = std::filesystem;

/// Voxels of boxes, each of which must be in one of them only.
test::VoxelSet voxelsOf(const std::vector<VoxelBox>& boxes) {
  test::VoxelSet voxels;
  for (const VoxelBox& box : boxes) {
    test::forEachVoxel(box, [&](const VoxelIndex& v) {
      EXPECT_TRUE(voxels.insert(v).second) << test::describe(v) << " twice";
    });
  }
  return voxels;
}

class MapFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("fiimap_map_files_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

/// A map at a place, in which boxes of all sizes are free or occupied.
class RandomMap {
 public:
  RandomMap(test::Random* random, double resolution, const VoxelIndex& place)
      : size_(test::uniformVoxel(*random, {{1, 1, 1}, {40, 40, 70}})), grid_(size_) {
    grid_.moveTo(place, &changes_);
    info_.resolution = resolution;
    for (int i = test::uniformInt(*random, 1, 12); i > 0; --i) {
      const VoxelIndex a = test::uniformVoxel(*random, grid_.window());
      const VoxelIndex b = a.array() + test::uniformInt(*random, 1, 16);
      const bool is_occupied = test::chance(*random, 0.5);
      const VoxelBox box = VoxelBox{a, b}.intersection(grid_.window());
      test::forEachVoxel(box, [&](const VoxelIndex& v) {
        grid_.set(Plane::kKnown, v, true);
        grid_.set(Plane::kOccupied, v, is_occupied);
      });
    }
    const VoxelIndex obstacle = test::uniformVoxel(*random, grid_.window());
    grid_.set(Plane::kKnown, obstacle, true);
    grid_.set(Plane::kOccupied, obstacle, true);
  }

  Snapshot snapshot() { return Snapshot(&grid_, info_); }
  test::VoxelSet occupied() const {
    test::VoxelSet voxels;
    grid_.forEach(Plane::kOccupied, grid_.window(), [&](const VoxelIndex& v) { voxels.insert(v); });
    return voxels;
  }
  test::VoxelSet free() const {
    test::VoxelSet voxels;
    grid_.forEach(Plane::kKnown, grid_.window(), [&](const VoxelIndex& v) {
      if (!grid_.test(Plane::kOccupied, v)) voxels.insert(v);
    });
    return voxels;
  }

 private:
  VoxelIndex size_;
  SlidingGrid grid_;
  ChangeSet changes_;
  Snapshot::Info info_;
};

TEST_F(MapFilesTest, ReadsWhatWasSaved) {
  test::Random random(561);
  const VoxelIndex places[] = {{0, 0, 0}, {-70, -33, -9}, {-32768, 31000, 5000}};
  const double resolutions[] = {0.1, 0.05, 0.123456789, 10.0};
  for (int round = 0; round < test::effort(60); ++round) {
    SCOPED_TRACE("seed 561, round " + std::to_string(round));
    RandomMap map(&random, resolutions[round % 4], places[round % 3]);
    saveMap(map.snapshot(), folder_, "map");
    const SavedMap saved = readMap(folder_, "map");
    EXPECT_EQ(saved.file, (folder_ / "map.bt").string());
    EXPECT_NEAR(saved.resolution, resolutions[round % 4], 1e-5 * saved.resolution);
    ASSERT_EQ(voxelsOf(saved.occupied), map.occupied());
    ASSERT_EQ(voxelsOf(saved.free), map.free());

    fs::remove(folder_ / "map.bt");
    const SavedMap obstacles = readMap(folder_, "map");
    EXPECT_EQ(obstacles.file, (folder_ / "map_occupied.pcd").string());
    EXPECT_NEAR(obstacles.resolution, resolutions[round % 4], 1e-5 * saved.resolution);
    ASSERT_EQ(voxelsOf(obstacles.occupied), map.occupied());
    ASSERT_TRUE(obstacles.free.empty());
  }
}

TEST_F(MapFilesTest, ReadsTheTreesOfTheOctomapLibrary) {
  test::Random random(562);
  const std::string file = folder_ / "tree.bt";
  for (int round = 0; round < test::effort(40); ++round) {
    SCOPED_TRACE("seed 562, round " + std::to_string(round));
    octomap::OcTree tree(0.1);
    constexpr int kKeys = 1 << 16;
    const int reach = 1 << test::uniformInt(random, 0, 6);
    const VoxelIndex corner =
        test::uniformVoxel(random, {VoxelIndex::Zero(), VoxelIndex::Constant(kKeys - reach + 1)});
    for (int i = 0; i < 400; ++i) {
      const VoxelIndex key =
          test::uniformVoxel(random, {corner, corner + VoxelIndex::Constant(reach)});
      const auto at = [&](int axis) { return static_cast<octomap::key_type>(key[axis]); };
      tree.updateNode(octomap::OcTreeKey(at(0), at(1), at(2)), test::chance(random, 0.5));
    }
    ASSERT_TRUE(tree.writeBinary(file));
    test::VoxelSet occupied, free;
    tree.expand();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      const octomap::OcTreeKey key = leaf.getKey();
      const VoxelIndex v = VoxelIndex(key[0], key[1], key[2]).array() - kKeys / 2;
      (tree.isNodeOccupied(*leaf) ? occupied : free).insert(v);
    }
    const SavedMap saved = readOctomap(file);
    EXPECT_EQ(saved.resolution, 0.1);
    ASSERT_EQ(voxelsOf(saved.occupied), occupied);
    ASSERT_EQ(voxelsOf(saved.free), free);
  }
}

TEST_F(MapFilesTest, ReadsATreeWithoutNodes) {
  octomap::OcTree tree(0.25);
  ASSERT_TRUE(tree.writeBinary(folder_ / "empty.bt"));
  const SavedMap saved = readMap(folder_, "empty");
  EXPECT_EQ(saved.resolution, 0.25);
  EXPECT_TRUE(saved.occupied.empty());
  EXPECT_TRUE(saved.free.empty());
}

}  // namespace
}  // namespace fiimap
