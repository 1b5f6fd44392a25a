#include "fiimap/sliding_grid.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

constexpr Plane kPlanes[] = {Plane::kKnown, Plane::kOccupied, Plane::kInflated};

using Drawing = std::vector<std::string>;

/// Sets what is drawn with '#'. Rows are x, columns are y, from the window's lowest corner.
void draw(const Drawing& drawing, Plane plane, SlidingGrid* grid) {
  for (std::size_t x = 0; x < drawing.size(); ++x) {
    for (std::size_t y = 0; y < drawing[x].size(); ++y) {
      const VoxelIndex v = grid->window().min + VoxelIndex(x, y, 0);
      if (drawing[x][y] == '#') grid->set(plane, v, true);
    }
  }
}

Drawing drawingOf(const SlidingGrid& grid, Plane plane) {
  const VoxelBox& window = grid.window();
  Drawing drawing(window.size().x(), std::string(window.size().y(), '.'));
  test::forEachVoxel(window, [&](const VoxelIndex& v) {
    const VoxelIndex d = v - window.min;
    if (grid.test(plane, v)) drawing[d.x()][d.y()] = '#';
  });
  return drawing;
}

test::VoxelSet asSet(const std::vector<VoxelIndex>& voxels) {
  return {voxels.begin(), voxels.end()};
}

TEST(SlidingGridTest, KeepsVoxelsThatStayInWindow) {
  SlidingGrid grid({5, 6, 1});
  ChangeSet changes;
  grid.moveTo({0, 0, 0}, &changes);
  // clang-format off
  draw({"#....#",
        ".#..#.",
        "..##..",
        ".#..#.",
        "#....#"}, Plane::kOccupied, &grid);
  // clang-format on

  grid.moveTo({2, -1, 0}, &changes);

  // clang-format off
  const Drawing expected = {"...##.",
                            "..#..#",
                            ".#....",
                            "......",
                            "......"};
  // clang-format on
  EXPECT_EQ(drawingOf(grid, Plane::kOccupied), expected);
  EXPECT_EQ(asSet(changes.forgotten),
            asSet({{0, 0, 0}, {0, 5, 0}, {1, 1, 0}, {1, 4, 0}, {4, 5, 0}}));
  EXPECT_EQ(changes.forgotten.size(), 5u);
  EXPECT_EQ(grid.count(Plane::kOccupied), 5);
}

TEST(SlidingGridTest, StartsUnknownAroundTheOrigin) {
  const SlidingGrid grid({4, 5, 6});
  EXPECT_EQ(grid.window().size(), VoxelIndex(4, 5, 6));
  EXPECT_TRUE(grid.window().contains({0, 0, 0}));
  for (const Plane plane : kPlanes) {
    EXPECT_TRUE(test::planeEquals(grid, plane, test::VoxelField(grid.window())));
  }
}

TEST(SlidingGridTest, PlanesAreIndependent) {
  SlidingGrid grid({3, 3, 3});
  grid.set(Plane::kKnown, {0, 0, 0}, true);
  grid.set(Plane::kOccupied, {1, 0, 0}, true);
  grid.set(Plane::kInflated, {0, 1, 0}, true);
  EXPECT_TRUE(grid.test(Plane::kKnown, {0, 0, 0}));
  EXPECT_FALSE(grid.test(Plane::kOccupied, {0, 0, 0}));
  EXPECT_FALSE(grid.test(Plane::kInflated, {0, 0, 0}));
  grid.clearPlane(Plane::kOccupied);
  EXPECT_EQ(grid.count(Plane::kKnown), 1);
  EXPECT_EQ(grid.count(Plane::kOccupied), 0);
  EXPECT_EQ(grid.count(Plane::kInflated), 1);
  EXPECT_FALSE(grid.test(Plane::kOccupied, {1, 0, 0}));
  EXPECT_TRUE(grid.test(Plane::kInflated, {0, 1, 0}));
}

TEST(SlidingGridTest, IgnoresVoxelsOutsideOfTheWindow) {
  for (const int height : {1, 60, 64, 65}) {
    SlidingGrid grid({32, 33, height});
    const VoxelBox window = grid.window();
    for (int axis = 0; axis < 3; ++axis) {
      for (const int beyond : {1, 64, 128, 1024}) {
        VoxelIndex below = window.min, above = window.max - VoxelIndex::Ones();
        below[axis] -= beyond;
        above[axis] += beyond;
        grid.set(Plane::kOccupied, below, true);
        grid.set(Plane::kOccupied, above, true);
        EXPECT_FALSE(grid.test(Plane::kOccupied, below));
        EXPECT_FALSE(grid.test(Plane::kOccupied, above));
      }
    }
    EXPECT_TRUE(test::planeEquals(grid, Plane::kOccupied, test::VoxelField(window)));
  }
}

/// Every axis and side: the voxels of a face, and a step of the window that leaves just them
/// behind.
TEST(SlidingGridTest, ForgetsTheFaceThatASlideLeavesBehind) {
  for (const VoxelIndex& size : {VoxelIndex(5, 4, 3), VoxelIndex(32, 64, 64),
                                 VoxelIndex(33, 31, 60), VoxelIndex(3, 3, 128)}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        SCOPED_TRACE(test::describe(size) + ", axis " + std::to_string(axis) + ", side " +
                     std::to_string(side));
        SlidingGrid grid(size);
        const VoxelBox window = grid.window();
        VoxelIndex at_face = window.min + size / 2;
        at_face[axis] = side < 0 ? window.min[axis] : window.max[axis] - 1;
        VoxelIndex opposite = at_face;
        opposite[axis] = side < 0 ? window.max[axis] - 1 : window.min[axis];
        grid.set(Plane::kOccupied, at_face, true);
        grid.set(Plane::kOccupied, opposite, true);

        VoxelIndex step = VoxelIndex::Zero();
        step[axis] = -side;
        ChangeSet changes;
        grid.moveTo(window.min + step, &changes);

        EXPECT_EQ(changes.forgotten, std::vector<VoxelIndex>{at_face});
        test::VoxelField expected(grid.window());
        expected.mark(opposite);
        EXPECT_TRUE(test::planeEquals(grid, Plane::kOccupied, expected));

        grid.moveTo(window.min, &changes);
        EXPECT_FALSE(grid.test(Plane::kOccupied, at_face)) << "came back";
      }
    }
  }
}

TEST(SlidingGridTest, ForgetsAllInASlideLargerThanTheWindow) {
  for (int axis = 0; axis < 3; ++axis) {
    // Multiples of the rings' sizes, where an address would be the same.
    for (const int distance : {7, 64, 128, 4096, -7, -64, -128, -1000000}) {
      SlidingGrid grid({7, 7, 7});
      ChangeSet changes;
      changes.forgotten = {{9, 9, 9}};
      test::VoxelSet expected{{9, 9, 9}};
      test::forEachVoxel(grid.window(), [&](const VoxelIndex& v) {
        for (const Plane plane : kPlanes) grid.set(plane, v, true);
        expected.insert(v);
      });
      VoxelIndex min = grid.window().min;
      min[axis] += distance;
      grid.moveTo(min, &changes);
      EXPECT_EQ(asSet(changes.forgotten), expected) << "appends every occupied voxel";
      EXPECT_EQ(changes.forgotten.size(), expected.size());
      for (const Plane plane : kPlanes) {
        EXPECT_TRUE(test::planeEquals(grid, plane, test::VoxelField(grid.window())));
      }
    }
  }
}

TEST(SlidingGridTest, ReplacesColumnsAndCounts) {
  SlidingGrid grid({3, 3, 70});
  ASSERT_GE(grid.layout().bits(), 70);
  const VoxelBox window = grid.window();
  std::vector<std::uint64_t> words(grid.layout().words());
  grid.heightMask(window.min.z() + 3, window.max.z() - 5, words.data());
  grid.writeColumn(Plane::kInflated, 1, -1, words.data());
  test::VoxelField expected(window);
  for (int z = window.min.z() + 3; z < window.max.z() - 5; ++z) expected.mark({1, -1, z});
  EXPECT_TRUE(test::planeEquals(grid, Plane::kInflated, expected));
  std::fill(words.begin(), words.end(), 0);
  grid.writeColumn(Plane::kInflated, 1, -1, words.data());
  EXPECT_TRUE(test::planeEquals(grid, Plane::kInflated, test::VoxelField(window)));
}

TEST(SlidingGridTest, CopiesASharedTileOnlyForAChange) {
  SlidingGrid grid({80, 80, 60});
  Strip row = {};
  row.words[3] = row.words[5] = 6;
  const std::uint32_t columns = 1u << 3 | 1u << 5;
  const auto replaceAndAdd = [&] {
    grid.replaceRows(Plane::kInflated, 7, 0, 1, &columns, &row);
    grid.addToColumns(Plane::kInflated, 9, 0, 1, Strip::kGroup, row.words, Strip::kColumns);
  };
  const Strip empty = {};
  grid.replaceRows(Plane::kInflated, 7, 0, 1, &columns, &empty);
  grid.addToColumns(Plane::kInflated, 9, 0, 1, Strip::kGroup, empty.words, Strip::kColumns);
  EXPECT_FALSE(grid.isLive(7, 0));
  replaceAndAdd();
  test::VoxelField expected(grid.window());
  for (const int x : {7, 9}) {
    for (const int y : {3, 5}) {
      for (const int z : {1, 2}) expected.mark({x, y, z});
    }
  }
  EXPECT_TRUE(test::planeEquals(grid, Plane::kInflated, expected));
  const auto shared = grid.shareTiles();
  replaceAndAdd();
  EXPECT_EQ(grid.shareTiles(), shared);
  row.words[5] = 7;
  grid.replaceRows(Plane::kInflated, 7, 0, 1, &columns, &row);
  const auto shared_again = grid.shareTiles();
  EXPECT_NE(shared_again, shared);
  grid.addToColumns(Plane::kInflated, 9, 0, 1, Strip::kGroup, row.words, Strip::kColumns);
  EXPECT_NE(grid.shareTiles(), shared_again);
  EXPECT_EQ(grid.count(Plane::kInflated), 10);
}

TEST(SlidingGridTest, HeightMaskHoldsTheHeightsOfTheRangeAndTheWindow) {
  for (const int height : {1, 30, 60, 63, 64, 65, 120, 128, 130}) {
    SlidingGrid grid({1, 1, height});
    ChangeSet changes;
    for (const int min_z : {-1000, -65, -64, -1, 0, 1, 63, 64, 100}) {
      grid.moveTo({0, 0, min_z}, &changes);
      for (const int low : {min_z - 70, min_z, min_z + 1, min_z + height / 2}) {
        for (const int high : {low - 1, low, low + 1, low + 65, min_z + height, min_z + 300}) {
          std::vector<std::uint64_t> words(grid.layout().words(), ~std::uint64_t{0});
          grid.heightMask(low, high, words.data());
          test::VoxelSet heights, expected;
          forEachBit(words.data(), grid.layout().words(), [&](int bit) {
            heights.insert({0, 0, grid.layout().heightOf(bit, min_z)});
          });
          for (int z = std::max(low, min_z); z < std::min(high, min_z + height); ++z) {
            expected.insert({0, 0, z});
          }
          ASSERT_EQ(heights, expected)
              << height << " from " << min_z << ": " << low << ", " << high;
        }
      }
    }
  }
}

TEST(SlidingGridTest, WorksFarFromTheOrigin) {
  // 10000 km at 0.01 m.
  constexpr int kFar = 1000000000;
  for (const int sign : {-1, 1}) {
    SlidingGrid grid({40, 33, 65});
    ChangeSet changes;
    const VoxelIndex min = VoxelIndex::Constant(sign * kFar);
    grid.moveTo(min, &changes);
    const VoxelIndex last = grid.window().max - VoxelIndex::Ones();
    grid.set(Plane::kOccupied, min, true);
    grid.set(Plane::kOccupied, last, true);
    grid.moveTo(min + VoxelIndex(1, 0, 0), &changes);
    EXPECT_EQ(changes.forgotten, std::vector<VoxelIndex>{min});
    EXPECT_TRUE(grid.test(Plane::kOccupied, last));
  }
}

TEST(SlidingGridTest, MemoryStaysBoundedOnALongFlight) {
  test::Random random(41);
  SlidingGrid grid({50, 50, 30});
  ChangeSet changes;
  std::size_t largest_at_first = 0, largest_later = 0;
  constexpr int kSteps = 3000;
  for (int step = 0; step < kSteps; ++step) {
    grid.moveTo(grid.window().min + VoxelIndex(3, -2, step % 2 == 0 ? 1 : -1), &changes);
    changes.clear();
    for (int i = 0; i < 5; ++i) {
      const VoxelIndex v = test::uniformVoxel(random, grid.window());
      grid.set(Plane::kOccupied, v, true);
      grid.logOdds(v.x(), v.y())[grid.layout().bitOf(v.z())] = 1;
    }
    if (step % 7 == 0) grid.shareTiles();
    std::size_t& largest = step < kSteps / 10 ? largest_at_first : largest_later;
    largest = std::max(largest, grid.memoryBytes());
    ASSERT_LE(grid.memoryBytes(), grid.worstCaseMemoryBytes()) << "seed 41, step " << step;
  }
  EXPECT_GT(largest_at_first, 0u);
  EXPECT_LE(largest_later, largest_at_first);
}

TEST(ColumnLayoutTest, GivesEveryHeightOfAWindowItsOwnBit) {
  for (const int height : {1, 30, 60, 63, 64, 65, 120, 128, 129, 130, 300}) {
    const ColumnLayout layout(height);
    ASSERT_GE(layout.bits(), height);
    for (const int min_z : {-100000, -129, -64, -63, -1, 0, 5, 64, 100000}) {
      std::set<int> bits;
      for (int z = min_z; z < min_z + height; ++z) {
        const int bit = layout.bitOf(z);
        ASSERT_GE(bit, 0);
        ASSERT_LT(bit, layout.bits());
        ASSERT_TRUE(bits.insert(bit).second);
        ASSERT_EQ(layout.heightOf(bit, min_z), z);
      }
    }
  }
}

TEST(TileRingTest, GivesEveryTileOfAWindowItsOwnSlot) {
  test::Random random(42);
  for (int round = 0; round < 300; ++round) {
    const int size_x = test::uniformInt(random, 1, 300), size_y = test::uniformInt(random, 1, 300);
    const int min_x = test::uniformInt(random, -2000, 2000);
    const int min_y = test::uniformInt(random, -2000, 2000);
    SCOPED_TRACE("seed 42: " + test::describe(VoxelBox{{min_x, min_y, 0}, {size_x, size_y, 0}}));
    const TileRing ring(size_x, size_y);
    std::map<int, VoxelIndex> tile_of_slot;
    for (int x = min_x; x < min_x + size_x; ++x) {
      for (int y = min_y; y < min_y + size_y; ++y) {
        const int slot = ring.slotOf(x, y);
        ASSERT_GE(slot, 0);
        ASSERT_LT(slot, ring.slots());
        const VoxelIndex tile(x - (x % kTileSide + kTileSide) % kTileSide,
                              y - (y % kTileSide + kTileSide) % kTileSide, 0);
        ASSERT_EQ(tile_of_slot.emplace(slot, tile).first->second, tile);
      }
    }
  }
}

}  // namespace
}  // namespace fiimap
