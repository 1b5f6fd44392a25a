#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/ray_caster.h"
#include "oracle.h"
#include "ray_oracle.h"

/// Ray casting against the exact reference, in both directions, over random scans.
namespace fiimap {
namespace {

using test::ExactPoint;
using test::RayOracle;

/// Where the sensor is.
enum class Place { kInside, kOutside, kOnFace, kAtCentre };

struct Setting {
  double resolution;
  VoxelBox box;
  double end_cut;
  Place place;
  bool round_rays;
};

ExactPoint inVoxels(const Eigen::Vector3d& point_W, double resolution) {
  return point_W.cast<long double>() / static_cast<long double>(resolution);
}

class ScanMaker {
 public:
  ScanMaker(const Setting& setting, test::Random* random) : setting_(setting), random_(*random) {}

  /// A scan of which the oracle knows everything; what rounding decides is left out.
  RangeData make(int rays, RayOracle* oracle) {
    RangeData scan;
    scan.origin = setting_.resolution * origin();
    const ExactPoint origin = inVoxels(scan.origin, setting_.resolution);
    for (int i = 0; i < rays; ++i) {
      const Eigen::Vector3f offset =
          (setting_.resolution * end(scan.origin / setting_.resolution) - scan.origin)
              .cast<float>();
      const ExactPoint end = inVoxels(scan.origin + offset.cast<double>(), setting_.resolution);
      const bool is_return = test::chance(random_, 0.6);
      if (!(is_return ? oracle->addReturn(origin, end) : oracle->addMiss(origin, end))) continue;
      (is_return ? scan.returns : scan.misses).push_back(offset);
    }
    const std::optional<int> half_side = oracle->halfSideOfCube(origin);
    if (!half_side)
      return make(rays,
                  &(*oracle = RayOracle(setting_.box, setting_.end_cut, setting_.round_rays)));
    oracle->cast(origin, *half_side);
    return scan;
  }

 private:
  /// In voxels.
  Eigen::Vector3d origin() {
    VoxelBox range = setting_.box;
    if (setting_.place == Place::kOutside) {
      range.min -= setting_.box.size();
      range.max += setting_.box.size();
    }
    const VoxelIndex v = test::voxelNearFaces(random_, range);
    switch (setting_.place) {
      case Place::kAtCentre:
        return v.cast<double>().array() + 0.5;
      case Place::kOnFace: {
        Eigen::Vector3d corner = v.cast<double>();
        if (test::chance(random_, 0.5)) corner[test::uniformInt(random_, 0, 2)] += 0.375;
        return corner;
      }
      default:
        return v.cast<double>() + insideVoxel();
    }
  }

  /// In voxels: in the box or around it, often in line with the origin or next to the last one.
  Eigen::Vector3d end(const Eigen::Vector3d& origin) {
    VoxelBox range = setting_.box;
    if (test::chance(random_, 0.3)) {
      range.min -= setting_.box.size();
      range.max += setting_.box.size();
    }
    const bool near_last = test::chance(random_, 0.5);
    if (!near_last) last_ = test::voxelNearFaces(random_, range);
    if (near_last) last_[test::uniformInt(random_, 0, 2)] += test::uniformInt(random_, -2, 2);
    Eigen::Vector3d end = last_.cast<double>() + insideVoxel();
    for (int axis = 0; axis < 3; ++axis) {
      if (test::chance(random_, 0.1)) end[axis] = origin[axis];
    }
    return end;
  }

  Eigen::Vector3d insideVoxel() {
    return Eigen::Vector3d::NullaryExpr(
        [&](Eigen::Index) { return test::uniformReal(random_, 0.01, 0.99); });
  }

  const Setting& setting_;
  test::Random& random_;
  VoxelIndex last_ = VoxelIndex::Zero();
};

void expectMarked(const ScanMask& mask, ScanMask::Layer layer, const test::VoxelSet& expected) {
  test::VoxelSet marked;
  test::forEachVoxel(mask.box(), [&](const VoxelIndex& v) {
    if (mask.test(layer, v - mask.box().min)) marked.insert(v);
  });
  ASSERT_EQ(marked, expected);
}

void expectFree(const ScanMask& mask, const RayOracle& oracle) {
  const VoxelIndex origin = mask.box().min;
  test::forEachVoxel(mask.box(), [&](const VoxelIndex& v) {
    const bool free = mask.test(ScanMask::kFree, v - origin);
    if (oracle.mustBeFree(v)) {
      ASSERT_TRUE(free) << test::describe(v) << " is not free";
    }
    if (!oracle.mayBeFree(v)) {
      ASSERT_FALSE(free) << test::describe(v) << " is free";
    }
    const bool any =
        free || mask.test(ScanMask::kHit, v - origin) || mask.test(ScanMask::kMissEnd, v - origin);
    if (any) {
      ASSERT_TRUE(mask.touched().containsColumn(v.x() - origin.x(), v.y() - origin.y()));
    }
  });
}

Setting randomSetting(test::Random& random) {
  constexpr double kResolutions[] = {0.0625, 0.25, 0.05, 0.1, 0.2};
  constexpr double kCuts[] = {0.0, 0.0, 0.5, 1.5, 1.5, 3.3, 1000.0};
  constexpr int kHeights[] = {1, 5, 20, 60, 64, 65, 100, 130};
  const VoxelIndex far = VoxelIndex::Constant(100000);
  Setting setting;
  setting.resolution = kResolutions[test::uniformInt(random, 0, 4)];
  setting.box.min = test::chance(random, 0.7)
                        ? test::uniformVoxel(random, {-far / 1000, far / 1000})
                        : test::uniformVoxel(random, {-far, far});
  setting.box.max =
      setting.box.min + VoxelIndex(test::uniformInt(random, 1, 20), test::uniformInt(random, 1, 40),
                                   kHeights[test::uniformInt(random, 0, 7)]);
  setting.end_cut = kCuts[test::uniformInt(random, 0, 6)];
  setting.place = static_cast<Place>(test::uniformInt(random, 0, 3));
  setting.round_rays = test::chance(random, 0.8);
  return setting;
}

std::string describe(const Setting& s, int round) {
  return "round " + std::to_string(round) + ", resolution " + std::to_string(s.resolution) +
         ", box " + test::describe(s.box) + ", cut " + std::to_string(s.end_cut) + ", place " +
         std::to_string(static_cast<int>(s.place)) + (s.round_rays ? ", rounded" : ", straight");
}

/// Boxes that the cube of directions does not fill.
Setting longSetting(test::Random& random) {
  Setting setting = randomSetting(random);
  VoxelIndex size(test::uniformInt(random, 600, 1000), test::uniformInt(random, 1, 5),
                  test::uniformInt(random, 1, 70));
  if (test::chance(random, 0.5)) std::swap(size.x(), size.y());
  setting.box.max = setting.box.min + size;
  return setting;
}

class RayCasterPropertyTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(RayCasterPropertyTest, AgreesWithTheExactReference) {
  test::Random random(GetParam());
  ScanMask mask;
  for (int round = 0; round < test::effort(120); ++round) {
    const bool is_long = test::chance(random, 0.05);
    const Setting setting = is_long ? longSetting(random) : randomSetting(random);
    SCOPED_TRACE(describe(setting, round));
    const bool is_dense = !is_long && test::chance(random, 0.1);
    const int rays =
        is_dense ? test::uniformInt(random, 100, 400) : test::uniformInt(random, 1, 25);
    RayOracle oracle(setting.box, setting.end_cut, setting.round_rays);
    const RangeData scan = ScanMaker(setting, &random).make(rays, &oracle);
    RayCaster caster(VoxelLattice(setting.resolution), setting.end_cut, 0.0, setting.round_rays);
    const RayCount count = caster.cast(scan, setting.box, &mask);
    ASSERT_EQ(mask.box(), setting.box);
    ASSERT_NO_FATAL_FAILURE(expectMarked(mask, ScanMask::kHit, oracle.hits()));
    ASSERT_NO_FATAL_FAILURE(expectMarked(mask, ScanMask::kMissEnd, oracle.missEnds()));
    ASSERT_NO_FATAL_FAILURE(expectFree(mask, oracle));
    ASSERT_EQ(count.hits, oracle.hits().size());
    ASSERT_EQ(count.misses, oracle.missEnds().size());
  }
}

/// All bits of a mask.
std::vector<char> bitsOf(const ScanMask& mask) {
  std::vector<char> bits;
  test::forEachVoxel({VoxelIndex::Zero(), mask.size()}, [&](const VoxelIndex& v) {
    for (const auto layer : {ScanMask::kHit, ScanMask::kMissEnd, ScanMask::kFree}) {
      bits.push_back(mask.test(layer, v));
    }
  });
  return bits;
}

TEST_P(RayCasterPropertyTest, NeitherOrderNorRepetitionOfPointsMatters) {
  test::Random random(1000 + GetParam());
  ScanMask mask, other_mask;
  for (int round = 0; round < test::effort(40); ++round) {
    const Setting setting = randomSetting(random);
    SCOPED_TRACE(describe(setting, round));
    RayOracle unused(setting.box, setting.end_cut, setting.round_rays);
    RangeData scan = ScanMaker(setting, &random).make(30, &unused);
    RayCaster caster(VoxelLattice(setting.resolution), setting.end_cut, 0.0, setting.round_rays);
    const RayCount count = caster.cast(scan, setting.box, &mask);

    for (auto* points : {&scan.returns, &scan.misses}) {
      std::vector<Eigen::Vector3f> twice = test::toVector(*points);
      const std::vector<Eigen::Vector3f> copy = twice;
      twice.insert(twice.end(), copy.begin(), copy.end());
      std::shuffle(twice.begin(), twice.end(), random);
      points->clear();
      for (const Eigen::Vector3f& point : twice) points->push_back(point);
    }
    const RayCount other_count = caster.cast(scan, setting.box, &other_mask);
    ASSERT_EQ(bitsOf(other_mask), bitsOf(mask));
    ASSERT_EQ(other_count.hits, count.hits);
    ASSERT_EQ(other_count.misses, count.misses);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RayCasterPropertyTest, ::testing::Range(1u, 9u));

}  // namespace
}  // namespace fiimap
