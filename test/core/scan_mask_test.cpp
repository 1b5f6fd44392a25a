#include "fiimap/scan_mask.h"

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

constexpr ScanMask::Layer kLayers[] = {ScanMask::kHit, ScanMask::kMissEnd, ScanMask::kFree};

TEST(ScanMaskTest, KeepsItsLayersApart) {
  ScanMask mask;
  mask.begin({{-3, 5, -100}, {4, 9, 30}});
  EXPECT_EQ(mask.size(), VoxelIndex(7, 4, 130));
  for (int i = 0; i < ScanMask::kLayerCount; ++i) {
    const VoxelIndex v(2 * i, i, 64 * i);
    mask.touch(v.x(), v.y());
    mask.mark(kLayers[i], v);
    for (int j = 0; j < ScanMask::kLayerCount; ++j) {
      EXPECT_EQ(mask.test(kLayers[j], v), i == j);
      EXPECT_EQ(mask.any(kLayers[j], v.x(), v.y()), i == j);
    }
  }
}

TEST(ScanMaskTest, FreeRunsAreClippedToTheBox) {
  test::Random random(51);
  for (int round = 0; round < 2000; ++round) {
    const int height = test::uniformInt(random, 1, 200);
    const int low = test::uniformInt(random, -80, height + 80);
    const int high = test::uniformInt(random, -80, height + 80);
    ScanMask mask;
    mask.begin({{0, 0, 7}, {2, 2, 7 + height}});
    mask.touch(1, 0);
    mask.markFreeRun(mask.columnOffset(1, 0), low, high);
    test::forEachVoxel({{0, 0, 0}, {2, 2, height}}, [&](const VoxelIndex& v) {
      const bool in_run = v.x() == 1 && v.y() == 0 && v.z() >= low && v.z() <= high;
      ASSERT_EQ(mask.test(ScanMask::kFree, v), in_run)
          << "seed 51, height " << height << ", run " << low << ".." << high << ", "
          << test::describe(v);
    });
  }
}

TEST(ScanMaskTest, FreeRunsAddUp) {
  ScanMask mask;
  mask.begin({{0, 0, 0}, {1, 1, 100}});
  mask.touch(0, 0);
  mask.markFreeRun(mask.columnOffset(0, 0), 60, 70);
  mask.markFreeRun(mask.columnOffset(0, 0), 10, 12);
  mask.markFreeRun(mask.columnOffset(0, 0), 65, 80);
  for (int z = 0; z < 100; ++z) {
    EXPECT_EQ(mask.test(ScanMask::kFree, {0, 0, z}), (z >= 10 && z <= 12) || (z >= 60 && z <= 80));
  }
}

TEST(ScanMaskTest, BeginForgetsTheScanBeforeWhateverTheSizes) {
  test::Random random(52);
  ScanMask mask;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE("seed 52, round " + std::to_string(round));
    const VoxelIndex size = test::uniformVoxel(random, {{0, 0, 0}, {12, 12, 150}});
    mask.begin({{5, -5, 5}, size + VoxelIndex(5, -5, 5)});
    if ((size.array() == 0).any()) continue;
    test::forEachVoxel({VoxelIndex::Zero(), size}, [&](const VoxelIndex& v) {
      for (const ScanMask::Layer layer : kLayers) ASSERT_FALSE(mask.test(layer, v));
    });
    for (int i = 0; i < 30; ++i) {
      const VoxelIndex v = test::voxelNearFaces(random, {VoxelIndex::Zero(), size});
      mask.touch(v.x(), v.y());
      mask.mark(kLayers[i % ScanMask::kLayerCount], v);
    }
  }
}

TEST(ScanMaskTest, TouchedIsTheSmallestRectangle) {
  ScanMask mask;
  mask.begin({{-10, -10, -10}, {10, 10, 10}});
  EXPECT_TRUE(mask.touched().empty());
  mask.touch(4, 7);
  EXPECT_TRUE(mask.touched().containsColumn(4, 7));
  EXPECT_FALSE(mask.touched().containsColumn(5, 7));
  mask.touch(2, 11);
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      EXPECT_EQ(mask.touched().containsColumn(x, y), x >= 2 && x <= 4 && y >= 7 && y <= 11);
    }
  }
}

}  // namespace
}  // namespace fiimap
