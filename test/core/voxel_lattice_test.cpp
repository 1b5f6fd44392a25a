#include "fiimap/voxel_lattice.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(VoxelBoxTest, IsHalfOpen) {
  const VoxelBox box{{-2, 0, 5}, {1, 3, 6}};
  EXPECT_TRUE(box.contains({-2, 0, 5}));
  EXPECT_TRUE(box.contains({0, 2, 5}));
  EXPECT_FALSE(box.contains({1, 2, 5}));
  EXPECT_FALSE(box.contains({0, 3, 5}));
  EXPECT_FALSE(box.contains({0, 2, 6}));
  EXPECT_FALSE(box.contains({-3, 0, 5}));
  EXPECT_TRUE(box.containsColumn(0, 2));
  EXPECT_FALSE(box.containsColumn(1, 2));
  EXPECT_FALSE(box.containsColumn(0, -1));
}

TEST(VoxelBoxTest, VolumeNeedsMoreThan32Bits) {
  const VoxelBox box{{-50000, -50000, 0}, {50000, 50000, 100}};
  EXPECT_EQ(box.volume(), 1000000000000);
}

TEST(VoxelBoxTest, InvertedBoxIsEmpty) {
  const VoxelBox box{{0, 5, 0}, {4, 4, 4}};
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.volume(), 0);
  EXPECT_EQ(VoxelBox{}.volume(), 0);
  EXPECT_TRUE((VoxelBox{{-3, -7, 0}, {-5, -9, 4}}.empty()));
  EXPECT_EQ((VoxelBox{{-3, -7, 0}, {-5, -9, 4}}.volume()), 0);
}

TEST(VoxelBoxTest, IntersectionHoldsTheVoxelsOfBoth) {
  test::Random random(11);
  const VoxelBox space{{-6, -6, -6}, {7, 7, 7}};
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const VoxelIndex a = test::uniformVoxel(random, space), b = test::uniformVoxel(random, space);
    const VoxelBox first{a, a + VoxelIndex(3, 5, 2)};
    const VoxelBox second{b, b + VoxelIndex(4, 1, 6)};
    const VoxelBox both = first.intersection(second);
    bool any = false;
    test::forEachVoxel(space, [&](const VoxelIndex& v) {
      const bool expected = first.contains(v) && second.contains(v);
      any = any || expected;
      ASSERT_EQ(both.contains(v), expected) << test::describe(v);
    });
    if (any) {
      EXPECT_FALSE(both.empty());
    }
  }
}

TEST(VoxelLatticeTest, FloorsNegativeCoordinates) {
  const VoxelLattice lattice(0.5);
  EXPECT_EQ(lattice.indexOf({0.0, 0.49, 0.5}), VoxelIndex(0, 0, 1));
  EXPECT_EQ(lattice.indexOf({-0.01, -0.5, -0.51}), VoxelIndex(-1, -1, -2));
  EXPECT_EQ(lattice.indexOf({-1000.0, 1000.0, -0.0}), VoxelIndex(-2000, 2000, 0));
}

TEST(VoxelLatticeTest, VoxelHoldsThePointsItCovers) {
  test::Random random(12);
  for (const double resolution : {0.01, 0.05, 0.1, 0.2, 0.25, 1.0, 10.0}) {
    const VoxelLattice lattice(resolution);
    for (int round = 0; round < 2000; ++round) {
      const Eigen::Vector3d point_W = Eigen::Vector3d::NullaryExpr(
          [&](Eigen::Index) { return test::uniformReal(random, -2000.0, 2000.0); });
      const VoxelIndex v = lattice.indexOf(point_W);
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kRounding = 1e-9;  // m
        EXPECT_GE(point_W[axis], v[axis] * resolution - kRounding) << "seed 12";
        EXPECT_LT(point_W[axis], (v[axis] + 1) * resolution + kRounding) << "seed 12";
      }
    }
  }
}

TEST(VoxelLatticeTest, CentreLiesInItsVoxelHoweverFar) {
  test::Random random(13);
  constexpr int kFar = 500000000;
  for (const double resolution : {0.01, 0.03, 0.1, 0.15, 0.2, 1.0, 10.0}) {
    const VoxelLattice lattice(resolution);
    for (int round = 0; round < 2000; ++round) {
      const VoxelIndex far = VoxelIndex::Constant(kFar);
      const VoxelIndex v = test::uniformVoxel(random, {-far, far});
      ASSERT_EQ(lattice.indexOf(lattice.centerOf(v)), v) << "seed 13 " << test::describe(v);
    }
  }
}

TEST(VoxelLatticeTest, CentreIsHalfAVoxelAboveTheCorner) {
  const VoxelLattice lattice(0.25);
  EXPECT_EQ(lattice.centerOf({0, -1, 3}), Eigen::Vector3d(0.125, -0.125, 0.875));
}

TEST(VoxelLatticeTest, CannotIndexWhatIsNotFinite) {
  const VoxelLattice lattice(0.1);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kNan, kInf, -kInf}) {
      Eigen::Vector3d point_W(1.0, 2.0, 3.0);
      point_W[axis] = bad;
      EXPECT_FALSE(lattice.canIndex(point_W)) << "axis " << axis << ", " << bad;
    }
  }
}

TEST(VoxelLatticeTest, CannotIndexBeyondTheRangeOfInt) {
  const VoxelLattice lattice(0.1);
  EXPECT_TRUE(lattice.canIndex({1e6, -1e7, 0.0}));
  for (const double beyond : {2147483648.0 * 0.1, 1e12, 1e300}) {
    EXPECT_FALSE(lattice.canIndex({beyond, 0.0, 0.0})) << beyond;
    EXPECT_FALSE(lattice.canIndex({0.0, -1.01 * beyond, 0.0})) << beyond;
    EXPECT_FALSE(lattice.canIndex({0.0, 0.0, beyond})) << beyond;
  }
}

TEST(VoxelLatticeTest, SizeIsRoundedAndAtLeastOne) {
  const VoxelLattice lattice(0.1);
  EXPECT_EQ(lattice.sizeOf({100.0, 6.0, 0.3}), VoxelIndex(1000, 60, 3));
  EXPECT_EQ(lattice.sizeOf({0.04, 0.0, 0.16}), VoxelIndex(1, 1, 2));
  EXPECT_EQ(VoxelLattice(0.3).sizeOf({100.0, 1.0, 0.9}), VoxelIndex(333, 3, 3));
}

TEST(VoxelLatticeTest, BoxAroundHasItsCentreInTheMiddle) {
  test::Random random(14);
  const VoxelIndex far = VoxelIndex::Constant(1000);
  for (int round = 0; round < 500; ++round) {
    const VoxelIndex center = test::uniformVoxel(random, {-far, far});
    const VoxelIndex size = test::uniformVoxel(random, {{1, 1, 1}, {9, 9, 9}});
    const VoxelBox box = VoxelLattice::boxAround(center, size);
    ASSERT_EQ(box.size(), size);
    ASSERT_TRUE(box.contains(center));
    const VoxelIndex below = center - box.min;
    const VoxelIndex above = box.max - VoxelIndex::Ones() - center;
    // Windows of even size have two middle voxels.
    ASSERT_LE((below - above).cwiseAbs().maxCoeff(), 1) << "seed 14 " << test::describe(box);
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] % 2 == 1) {
        ASSERT_EQ(below[axis], above[axis]);
      }
    }
  }
}

}  // namespace
}  // namespace fiimap
