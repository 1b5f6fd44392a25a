#include "fiimap/ray_caster.h"

#include <string>

#include <gtest/gtest.h>

#include "oracle.h"
#include "ray_oracle.h"

/// Named cases; expectations are written by hand.
namespace fiimap {
namespace {

constexpr double kResolution = 0.25;

/// Coordinates of points are in voxels here.
class Cast {
 public:
  Cast(const VoxelBox& box, double end_cut)
      : box_(box), caster_(VoxelLattice(kResolution), end_cut) {}

  Cast& from(const Eigen::Vector3d& origin) {
    scan_.origin = origin * kResolution;
    return *this;
  }
  Cast& toReturn(const Eigen::Vector3d& end) {
    scan_.returns.push_back((end * kResolution - scan_.origin).cast<float>());
    return *this;
  }
  Cast& toMiss(const Eigen::Vector3d& end) {
    scan_.misses.push_back((end * kResolution - scan_.origin).cast<float>());
    return *this;
  }
  RayCount run() { return caster_.cast(scan_, box_, &mask_); }

  test::VoxelSet marked(ScanMask::Layer layer) const {
    test::VoxelSet voxels;
    test::forEachVoxel(box_, [&](const VoxelIndex& v) {
      if (mask_.test(layer, v - box_.min)) voxels.insert(v);
    });
    return voxels;
  }
  test::VoxelSet hits() const { return marked(ScanMask::kHit); }
  test::VoxelSet free() const { return marked(ScanMask::kFree); }

 private:
  VoxelBox box_;
  RayCaster caster_;
  RangeData scan_;
  ScanMask mask_;
};

const VoxelBox kBox{{-5, -5, -5}, {10, 10, 10}};

/// Voxels from + i * step for i = 0..count-1.
test::VoxelSet line(const VoxelIndex& from, const VoxelIndex& step, int count) {
  test::VoxelSet voxels;
  for (int i = 0; i < count; ++i) voxels.insert(from + i * step);
  return voxels;
}

TEST(RayCasterTest, FreesAllVoxelsUpToAReturnAndHitsIt) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const VoxelIndex step = side * VoxelIndex::Unit(axis);
      Cast cast(kBox, 0.0);
      cast.from({0.5, 0.5, 0.5})
          .toReturn(Eigen::Vector3d::Constant(0.5) + 4.0 * step.cast<double>());
      const RayCount count = cast.run();
      EXPECT_EQ(cast.hits(), test::VoxelSet{4 * step}) << "axis " << axis << ", side " << side;
      EXPECT_EQ(cast.free(), line({0, 0, 0}, step, 5)) << "axis " << axis << ", side " << side;
      EXPECT_EQ(count.hits, 1u);
      EXPECT_EQ(count.misses, 0u);
    }
  }
}

TEST(RayCasterTest, EndCutLeavesTheVoxelsInFrontOfAReturn) {
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = VoxelIndex::Unit(axis);
    Eigen::Vector3d end(0.5, 0.5, 0.5);
    end[axis] += 5.0;
    // From the centre of voxel 5 at 5.5 back to 4.75, 4.0 + a bit, and 3.75.
    for (const auto& [cut, last] : {std::pair<double, int>{0.75, 4}, {1.4, 4}, {1.75, 3}}) {
      Cast cast(kBox, cut);
      cast.from({0.5, 0.5, 0.5}).toReturn(end).run();
      EXPECT_EQ(cast.hits(), test::VoxelSet{5 * step});
      EXPECT_EQ(cast.free(), line({0, 0, 0}, step, last + 1)) << "axis " << axis << ", cut " << cut;
    }
  }
}

TEST(RayCasterTest, EndCutDoesNotShortenAMiss) {
  Cast cast(kBox, 1.75);
  cast.from({0.5, 0.5, 0.5}).toMiss({5.5, 0.5, 0.5});
  const RayCount count = cast.run();
  EXPECT_TRUE(cast.hits().empty());
  EXPECT_EQ(cast.free(), line({0, 0, 0}, {1, 0, 0}, 6));
  EXPECT_EQ(cast.marked(ScanMask::kMissEnd), (test::VoxelSet{{5, 0, 0}}));
  EXPECT_EQ(count.hits, 0u);
  EXPECT_EQ(count.misses, 1u);
}

TEST(RayCasterTest, ARayShorterThanTheCutFreesNothing) {
  for (const double cut : {2.1, 5.0, 100.0}) {
    Cast cast(kBox, cut);
    cast.from({0.5, 0.5, 0.5}).toReturn({2.5, 0.5, 0.5}).run();
    EXPECT_EQ(cast.hits(), (test::VoxelSet{{2, 0, 0}}));
    EXPECT_TRUE(cast.free().empty()) << "cut " << cut;
  }
}

TEST(RayCasterTest, ARayOfLengthZeroStaysInItsVoxel) {
  Cast hit(kBox, 0.0);
  hit.from({2.5, 2.5, 2.5}).toReturn({2.5, 2.5, 2.5}).run();
  EXPECT_EQ(hit.hits(), (test::VoxelSet{{2, 2, 2}}));
  EXPECT_EQ(hit.free(), (test::VoxelSet{{2, 2, 2}}));
  Cast miss(kBox, 1.5);
  miss.from({2.5, 2.5, 2.5}).toMiss({2.5, 2.5, 2.5}).run();
  EXPECT_TRUE(miss.hits().empty());
  EXPECT_EQ(miss.free(), (test::VoxelSet{{2, 2, 2}}));
}

TEST(RayCasterTest, ARayThatEndsInTheOriginsVoxelFreesItAlone) {
  Cast cast(kBox, 0.0);
  cast.from({2.25, 2.75, 2.5}).toReturn({2.75, 2.125, 2.875}).run();
  EXPECT_EQ(cast.hits(), (test::VoxelSet{{2, 2, 2}}));
  EXPECT_EQ(cast.free(), (test::VoxelSet{{2, 2, 2}}));
}

TEST(RayCasterTest, ARayThatLeavesTheBoxIsAMissInItsLastVoxel) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      Eigen::Vector3d end(0.5, 0.5, 0.5);
      end[axis] += side * 60.0;
      const int last = side < 0 ? -5 : 9;
      for (const bool is_return : {false, true}) {
        Cast cast(kBox, 1.5);
        cast.from({0.5, 0.5, 0.5});
        const RayCount count = (is_return ? cast.toReturn(end) : cast.toMiss(end)).run();
        EXPECT_TRUE(cast.hits().empty());
        const VoxelIndex step = side * VoxelIndex::Unit(axis);
        EXPECT_EQ(cast.free(), line({0, 0, 0}, step, std::abs(last) + 1)) << axis << ", " << side;
        EXPECT_EQ(cast.marked(ScanMask::kMissEnd), test::VoxelSet{std::abs(last) * step});
        EXPECT_EQ(count.misses, 1u);
        EXPECT_EQ(count.hits, 0u);
      }
    }
  }
}

TEST(RayCasterTest, ARayFromOutsideOfTheBoxFreesFromWhereItEnters) {
  Cast cast(kBox, 0.0);
  cast.from({-40.5, 0.5, 0.5}).toReturn({-3.5, 0.5, 0.5}).run();
  EXPECT_EQ(cast.hits(), (test::VoxelSet{{-4, 0, 0}}));
  EXPECT_EQ(cast.free(), line({-5, 0, 0}, {1, 0, 0}, 2));

  Cast through(kBox, 0.0);
  const RayCount count = through.from({0.5, 0.5, 50.5}).toReturn({0.5, 0.5, -50.5}).run();
  EXPECT_TRUE(through.hits().empty());
  EXPECT_EQ(through.free(), line({0, 0, -5}, {0, 0, 1}, 15));
  EXPECT_EQ(count.misses, 1u);
}

TEST(RayCasterTest, ARayThatPassesTheBoxByMarksNothing) {
  Cast cast(kBox, 0.0);
  const RayCount count = cast.from({-40.5, 20.5, 0.5})
                             .toReturn({40.5, 21.5, 0.5})
                             .toMiss({-60.5, 0.5, 0.5})
                             .toReturn({-39.5, 0.5, 0.5})
                             .run();
  EXPECT_TRUE(cast.hits().empty());
  EXPECT_TRUE(cast.free().empty());
  EXPECT_EQ(count.hits + count.misses, 0u);
}

TEST(RayCasterTest, ManyReturnsInOneVoxelAreOneRay) {
  Cast cast(kBox, 0.0);
  for (int i = 0; i < 50; ++i) cast.from({0.5, 0.5, 0.5}).toReturn({4.1 + 0.015 * i, 0.3, 0.7});
  const RayCount count = cast.run();
  EXPECT_EQ(count.hits, 1u);
  EXPECT_EQ(cast.hits(), (test::VoxelSet{{4, 0, 0}}));
  EXPECT_EQ(cast.free(), line({0, 0, 0}, {1, 0, 0}, 5)) << "to the voxel's centre";
}

TEST(RayCasterTest, AVoxelMayBeHitAndFree) {
  Cast cast(kBox, 0.0);
  cast.from({0.5, 0.5, 0.5}).toReturn({2.5, 0.5, 0.5}).toReturn({4.5, 0.5, 0.5}).run();
  EXPECT_EQ(cast.hits(), (test::VoxelSet{{2, 0, 0}, {4, 0, 0}}));
  EXPECT_EQ(cast.free(), line({0, 0, 0}, {1, 0, 0}, 5));
}

TEST(RayCasterTest, ACastForgetsTheOneBefore) {
  Cast cast(kBox, 0.0);
  cast.from({0.5, 0.5, 0.5}).toReturn({4.5, 3.5, 2.5}).run();
  RangeData nothing;
  RayCaster caster(VoxelLattice(kResolution), 0.0);
  ScanMask mask;
  RangeData something;
  something.returns.push_back({1.0f, 0.5f, 0.75f});
  caster.cast(something, kBox, &mask);
  const RayCount count = caster.cast(nothing, kBox, &mask);
  EXPECT_EQ(count.hits + count.misses, 0u);
  test::forEachVoxel(kBox, [&](const VoxelIndex& v) {
    for (const auto layer : {ScanMask::kHit, ScanMask::kMissEnd, ScanMask::kFree}) {
      ASSERT_FALSE(mask.test(layer, v - kBox.min)) << test::describe(v);
    }
  });
}

TEST(RayCasterTest, AnEmptyBoxTakesNoRays) {
  Cast cast({{3, 3, 3}, {3, 9, 9}}, 0.0);
  const RayCount count = cast.from({0.5, 0.5, 0.5}).toReturn({4.5, 4.5, 4.5}).run();
  EXPECT_EQ(count.hits + count.misses, 0u);
  Cast inverted({{3, 3, 3}, {-3, 9, -9}}, 0.0);
  EXPECT_EQ(inverted.from({0.5, 0.5, 0.5}).toMiss({4.5, 4.5, 4.5}).run().misses, 0u);
}

TEST(RayCasterTest, ASensorFarFromTheBoxIsNoTrouble) {
  // Would not end in time if the walk began at the sensor.
  Cast cast(kBox, 0.0);
  for (int i = 0; i < 1000; ++i) {
    cast.from({-4e8, 0.5 - 0.001 * i, 4e8}).toReturn({4e8, 0.5, 0.25 * i});
  }
  EXPECT_EQ(cast.run().hits, 0u);
}

TEST(RayCasterTest, BetweenTheRaysThatPassCutRaysFreeNothing) {
  // A wall from floor to top: rays to its middle are the shortest and end first.
  const VoxelBox box{{0, 0, 0}, {12, 3, 41}};
  Cast cast(box, 5.0);
  cast.from({0.5, 1.5, 20.5});
  for (int z = 0; z < 41; ++z) cast.toReturn({11.5, 1.5, z + 0.5});
  cast.run();
  const test::VoxelSet free = cast.free();
  // The middle rays are 11 long and end at x = 6.5; the outermost, 22.8 long, at x = 9.1.
  EXPECT_EQ(free.count({5, 1, 20}), 1u);
  for (int z = 16; z <= 24; ++z) EXPECT_EQ(free.count({8, 1, z}), 0u) << z;
  EXPECT_EQ(free.count({8, 1, 6}), 1u);
  EXPECT_EQ(free.count({8, 1, 34}), 1u);
}

TEST(RayCasterTest, RaysAtTheCubesLimitStayInTheTouchedColumns) {
  // As far along x as the largest cube, half a cell beside the middle of a cell along y.
  const VoxelBox box{{0, 0, 0}, {600, 100, 1}};
  RayCaster caster{VoxelLattice(kResolution), 0.0};
  ScanMask mask;
  for (int y = 4; y < 100; ++y) {
    RangeData scan;
    scan.origin = Eigen::Vector3d(0.5, 3.0, 0.5) * kResolution;
    const Eigen::Vector3d end = Eigen::Vector3d(512.5, y + 0.5, 0.5) * kResolution;
    scan.misses.push_back((end - scan.origin).cast<float>());
    caster.cast(scan, box, &mask);
    for (int x = 500; x < 520; ++x) {
      for (int column = 0; column < 100; ++column) {
        const bool is_touched = mask.touched().containsColumn(x, column);
        ASSERT_TRUE(is_touched || !mask.any(ScanMask::kFree, x, column)) << y << ", " << column;
      }
    }
  }
}

TEST(RayCasterTest, RaysFromAboveOrBelowFreeNothingBeyondTheBox) {
  // A fan of rays that are cut one after the other, from a sensor beyond the box's top or floor.
  constexpr int kHeight = 20;  // of 64 bits in a word
  const VoxelBox box{{0, 0, 0}, {20, 3, kHeight}};
  for (const double sensor_z : {45.5, -25.5}) {
    RayCaster caster{VoxelLattice(kResolution), 12.0};
    RangeData scan;
    scan.origin = Eigen::Vector3d(0.5, 1.5, sensor_z) * kResolution;
    for (int z = 0; z < kHeight; ++z) {
      const Eigen::Vector3d end = Eigen::Vector3d(19.5, 1.5, z + 0.5) * kResolution;
      scan.returns.push_back((end - scan.origin).cast<float>());
    }
    ScanMask mask;
    EXPECT_EQ(caster.cast(scan, box, &mask).hits, kHeight);
    int freed = 0;
    for (int x = 0; x < 20; ++x) {
      const std::uint64_t word = mask.column(ScanMask::kFree, x, 1)[0];
      EXPECT_EQ(word >> kHeight, 0u) << x << ", sensor at " << sensor_z;
      freed += word != 0 ? 1 : 0;
    }
    EXPECT_GT(freed, 0);
  }
}

}  // namespace
}  // namespace fiimap
