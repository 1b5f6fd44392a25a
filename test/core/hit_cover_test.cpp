// Which voxels stop being hit because the returns in them cover too little: by the definition.

#include <gtest/gtest.h>

#include <map>

#include "fiimap/depth_projector.h"
#include "fiimap/ray_caster.h"
#include "oracle.h"

namespace fiimap {
namespace {

constexpr double kCoverResolution = 0.25;
constexpr double kEndCut = 1.5;
const VoxelBox kCoverBox{{-3, -20, -40}, {25, 22, 60}};

/// Rows of neighbouring returns, in voxels: a far wall, and in front of it slivers that end
/// anywhere within a voxel. Coordinates are odd thirty-seconds: no rounding, and no point on a
/// face.
/// From a sensor before the box, some rays look away from it.
RangeData rows(test::Random* random, bool before_box) {
  RangeData scan;
  scan.origin = Eigen::Vector3d(before_box ? -7.5 : 0.5, 0.5, 0.5) * kCoverResolution;
  for (int i = 0; before_box && i < 500; ++i) {
    scan.returns.push_back((Eigen::Vector3d(-10.0, i / 4.0, 3.0) * kCoverResolution).cast<float>());
  }
  scan.returns_per_steradian = test::uniformReal(*random, 500.0, 4000.0);
  for (int row = 0; row < 60; ++row) {
    const double height = (2 * test::uniformInt(*random, -160, 160) + 1) / 32.0;
    const int sliver_end = test::uniformInt(*random, 0, 60);
    for (int i = 0; i < 120; ++i) {
      const double distance = i < sliver_end ? 8.0 : 16.0;
      const Eigen::Vector3d end(distance + 1.0 / 32.0, (2 * i - 121) / 32.0, height);
      scan.returns.push_back((end * kCoverResolution - scan.origin).cast<float>());
    }
  }
  return scan;
}

TEST(HitCoverTest, DropsFreeVoxelsThatReturnsCoverTooLittle) {
  const VoxelLattice lattice(kCoverResolution);
  std::size_t dropped = 0, kept = 0;
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    const RangeData scan = rows(&random, seed % 2 == 1);
    const double min_cover = test::uniformReal(random, 0.05, 0.5);
    std::map<VoxelIndex, int, test::VoxelLess> returns;
    for (const Eigen::Vector3f& end : scan.returns) {
      ++returns[lattice.indexOf(scan.origin + end.cast<double>())];
    }
    ScanMask all, covered;
    RayCaster(lattice, kEndCut).cast(scan, kCoverBox, &all);
    RayCaster(lattice, kEndCut, min_cover).cast(scan, kCoverBox, &covered);
    test::forEachVoxel(kCoverBox, [&](const VoxelIndex& v) {
      const VoxelIndex at = v - kCoverBox.min;
      const bool free = all.test(ScanMask::kFree, at);
      ASSERT_EQ(covered.test(ScanMask::kFree, at), free);
      const double distance = (lattice.centerOf(v) - scan.origin).norm();
      const double full = scan.returns_per_steradian * std::pow(kCoverResolution / distance, 2);
      const auto found = returns.find(v);
      const double cover = found == returns.end() ? 0.0 : found->second / full;
      if (std::abs(cover - min_cover) < 1e-4) return;  // rounding decides
      const bool is_hit = cover > 0.0 && !(free && cover < min_cover);
      ASSERT_EQ(covered.test(ScanMask::kHit, at), is_hit) << v.transpose();
      if (free && cover > 0.0) ++(is_hit ? kept : dropped);
    });
  }
  EXPECT_GT(dropped, 100u);
  EXPECT_GT(kept, 100u);
}

TEST(HitCoverTest, KeepsAllHitsOfAScanOfUnknownDensity) {
  test::Random random(1);
  RangeData scan = rows(&random, false);
  scan.returns_per_steradian = 0.0;
  const VoxelLattice lattice(kCoverResolution);
  ScanMask all, covered;
  RayCaster(lattice, kEndCut).cast(scan, kCoverBox, &all);
  RayCaster(lattice, kEndCut, 1.0).cast(scan, kCoverBox, &covered);
  test::forEachVoxel({VoxelIndex::Zero(), kCoverBox.size()}, [&](const VoxelIndex& at) {
    ASSERT_EQ(covered.test(ScanMask::kHit, at), all.test(ScanMask::kHit, at));
  });
}

TEST(HitCoverTest, ADepthImageKnowsItsDensity) {
  MapperConfig config;
  config.pixel_step = 2;
  const std::vector<float> pixels(64 * 48, 2.0f);
  DepthImage image;
  image.data = pixels.data();
  image.format = DepthImage::Format::kFloat32;
  image.width = 64;
  image.height = 48;
  image.row_bytes = 64 * sizeof(float);
  RangeData scan;
  DepthProjector(config).project(image, {100.0, 110.0, 31.5, 23.5}, Eigen::Isometry3d::Identity(),
                                 &scan);
  EXPECT_DOUBLE_EQ(scan.returns_per_steradian, 100.0 / 2.0 * 110.0 / 2.0);
}

}  // namespace
}  // namespace fiimap
