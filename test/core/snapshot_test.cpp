#include "fiimap/snapshot.h"

#include <algorithm>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.5;
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Snapshot::Info info() {
  Snapshot::Info info;
  info.stamp_ns = 123;
  info.sequence = 7;
  info.resolution = kResolution;
  info.inflation_shape = ElementShape::kDiamond;
  info.inflation_radius = 0.75;
  return info;
}

/// A window of 8 x 8 x 8 voxels with one voxel of each kind and the rest unknown.
class SnapshotTest : public ::testing::Test {
 protected:
  SnapshotTest() : grid_({8, 8, 8}) {
    grid_.set(Plane::kKnown, kFreeVoxel, true);
    grid_.set(Plane::kKnown, kOccupiedVoxel, true);
    grid_.set(Plane::kOccupied, kOccupiedVoxel, true);
    for (const VoxelIndex& v : {kOccupiedVoxel, kInflatedUnknown, kInflatedFree}) {
      grid_.set(Plane::kInflated, v, true);
    }
    grid_.set(Plane::kKnown, kInflatedFree, true);
  }

  const VoxelIndex kFreeVoxel{-4, -4, -4};
  const VoxelIndex kOccupiedVoxel{3, 3, 3};
  const VoxelIndex kInflatedUnknown{3, 3, 2};
  const VoxelIndex kInflatedFree{3, 2, 3};
  const VoxelIndex kUnknownVoxel{0, 0, 0};
  SlidingGrid grid_;
};

TEST_F(SnapshotTest, GivesFourAnswers) {
  const Snapshot snapshot(&grid_, info());
  EXPECT_EQ(snapshot.occupancy(kFreeVoxel), Occupancy::kFree);
  EXPECT_EQ(snapshot.occupancy(kOccupiedVoxel), Occupancy::kOccupied);
  EXPECT_EQ(snapshot.occupancy(kUnknownVoxel), Occupancy::kUnknown);
  EXPECT_EQ(snapshot.occupancy(kInflatedUnknown), Occupancy::kUnknown);
  EXPECT_EQ(snapshot.occupancy(kInflatedFree), Occupancy::kFree);
  EXPECT_EQ(snapshot.inflation(kFreeVoxel), Inflation::kFree);
  EXPECT_EQ(snapshot.inflation(kOccupiedVoxel), Inflation::kInflated);
  EXPECT_EQ(snapshot.inflation(kUnknownVoxel), Inflation::kUnknown);
  EXPECT_EQ(snapshot.inflation(kInflatedUnknown), Inflation::kInflated);
  EXPECT_EQ(snapshot.inflation(kInflatedFree), Inflation::kInflated);
}

TEST_F(SnapshotTest, IsOutsideBeyondEveryFace) {
  const Snapshot snapshot(&grid_, info());
  for (int axis = 0; axis < 3; ++axis) {
    for (const int beyond : {-5, 4, -1000000, 64, 32}) {
      VoxelIndex v = VoxelIndex::Zero();
      v[axis] = beyond;
      EXPECT_EQ(snapshot.occupancy(v), Occupancy::kOutside) << test::describe(v);
      EXPECT_EQ(snapshot.inflation(v), Inflation::kOutside) << test::describe(v);
      const Eigen::Vector3d point_W = snapshot.lattice().centerOf(v);
      EXPECT_EQ(snapshot.occupancy(point_W), Occupancy::kOutside) << test::describe(v);
      EXPECT_EQ(snapshot.inflation(point_W), Inflation::kOutside) << test::describe(v);
    }
  }
}

TEST_F(SnapshotTest, APointHasTheStateOfItsVoxel) {
  const Snapshot snapshot(&grid_, info());
  test::Random random(81);
  const Eigen::Vector3d corner = kResolution * kOccupiedVoxel.cast<double>();
  for (int round = 0; round < 100; ++round) {
    const Eigen::Vector3d inside = Eigen::Vector3d::NullaryExpr(
        [&](Eigen::Index) { return test::uniformReal(random, 0.0, 0.999 * kResolution); });
    EXPECT_EQ(snapshot.occupancy((corner + inside).eval()), Occupancy::kOccupied) << "seed 81";
    EXPECT_EQ(snapshot.inflation((corner + inside).eval()), Inflation::kInflated) << "seed 81";
  }
  EXPECT_EQ(snapshot.occupancy(Eigen::Vector3d(-2.0, -2.0, -1.501)), Occupancy::kFree);
  EXPECT_EQ(snapshot.occupancy(Eigen::Vector3d(-2.0, -2.0, -1.5)), Occupancy::kUnknown);
  EXPECT_EQ(snapshot.occupancy(Eigen::Vector3d(-2.0, -2.0, -2.001)), Occupancy::kOutside);
}

TEST_F(SnapshotTest, PointsThatAreNotFiniteOrAbsurdAreOutside) {
  Snapshot::Info with_walls = info();
  with_walls.walls = {-0.1, 1.0};
  for (const Snapshot::Info& i : {info(), with_walls}) {
    const Snapshot snapshot(&grid_, i);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double bad : {kNan, kInf, -kInf, 1e300, -1e300, 2147483648.0 * kResolution}) {
        Eigen::Vector3d point_W(0.1, 0.1, 0.1);
        point_W[axis] = bad;
        EXPECT_EQ(snapshot.occupancy(point_W), Occupancy::kOutside) << point_W.transpose();
        EXPECT_EQ(snapshot.inflation(point_W), Inflation::kOutside) << point_W.transpose();
      }
    }
  }
}

TEST_F(SnapshotTest, VirtualWallsAreObstaclesInsideOfTheWindow) {
  Snapshot::Info walled = info();
  walled.walls = {-0.6, 1.1};
  const Snapshot snapshot(&grid_, walled);
  // Centres of the voxels at heights -2, -1, 0, 1, 2 are at -0.75, -0.25, 0.25, 0.75, 1.25 m.
  for (const int z : {-4, -3, -2, 2, 3}) {
    EXPECT_EQ(snapshot.occupancy(VoxelIndex(1, 1, z)), Occupancy::kOccupied) << z;
    EXPECT_EQ(snapshot.inflation(VoxelIndex(1, 1, z)), Inflation::kInflated) << z;
  }
  for (const int z : {-1, 0, 1}) {
    EXPECT_EQ(snapshot.occupancy(VoxelIndex(1, 1, z)), Occupancy::kUnknown) << z;
    EXPECT_EQ(snapshot.inflation(VoxelIndex(1, 1, z)), Inflation::kUnknown) << z;
  }
  EXPECT_EQ(snapshot.occupancy(VoxelIndex(1, 1, -5)), Occupancy::kOutside);
  EXPECT_EQ(snapshot.occupancy(VoxelIndex(1, 1, 4)), Occupancy::kOutside);
  // A point counts by its own height, not by its voxel's.
  EXPECT_EQ(snapshot.occupancy(Eigen::Vector3d(0.1, 0.1, -0.61)), Occupancy::kOccupied);
  EXPECT_EQ(snapshot.occupancy(Eigen::Vector3d(0.1, 0.1, -0.59)), Occupancy::kUnknown);
  EXPECT_EQ(snapshot.inflation(Eigen::Vector3d(0.1, 0.1, 1.11)), Inflation::kInflated);
  EXPECT_EQ(snapshot.inflation(Eigen::Vector3d(0.1, 0.1, 1.09)), Inflation::kUnknown);
  EXPECT_EQ(snapshot.inflation(Eigen::Vector3d(0.1, 0.1, 2.1)), Inflation::kOutside);
}

TEST_F(SnapshotTest, VirtualWallsAddNoVoxels) {
  Snapshot::Info walled = info();
  walled.walls = {-0.6, 1.1};
  const Snapshot snapshot(&grid_, walled);
  EXPECT_EQ(snapshot.count(Plane::kOccupied), 1);
  EXPECT_EQ(snapshot.count(Plane::kInflated), 3);
  EXPECT_EQ(snapshot.voxels(Plane::kOccupied, snapshot.window()),
            std::vector<VoxelIndex>{kOccupiedVoxel});
}

TEST_F(SnapshotTest, RemembersItsCircumstances) {
  std::vector<std::shared_ptr<const Tile>> other = grid_.shareTiles();
  const Snapshot snapshot(&grid_, info());
  EXPECT_EQ(snapshot.info().stamp_ns, 123);
  EXPECT_EQ(snapshot.info().sequence, 7u);
  EXPECT_EQ(snapshot.info().resolution, kResolution);
  EXPECT_EQ(snapshot.lattice().resolution(), kResolution);
  EXPECT_EQ(snapshot.info().inflation_shape, ElementShape::kDiamond);
  EXPECT_EQ(snapshot.info().inflation_radius, 0.75);
  EXPECT_EQ(snapshot.window(), grid_.window()) << "the window belongs to the cells";
}

TEST_F(SnapshotTest, OutlivesItsGrid) {
  auto grid = std::make_unique<SlidingGrid>(VoxelIndex(4, 4, 4));
  grid->set(Plane::kOccupied, {1, 1, 1}, true);
  const Snapshot snapshot(grid.get(), info());
  grid.reset();
  EXPECT_EQ(snapshot.occupancy(VoxelIndex(1, 1, 1)), Occupancy::kOccupied);
}

class SnapshotPropertyTest : public ::testing::TestWithParam<VoxelIndex> {};

TEST_P(SnapshotPropertyTest, ExtractsTheVoxelsOfABoxInOrder) {
  test::Random random(82);
  SlidingGrid grid(GetParam());
  ChangeSet changes;
  for (int round = 0; round < 30; ++round) {
    grid.moveTo(grid.window().min + test::randomSlide(random, GetParam()), &changes);
    test::VoxelSet set;
    grid.clear();
    for (int i = 0; i < 200; ++i) {
      const VoxelIndex v = test::voxelNearFaces(random, grid.window());
      grid.set(Plane::kInflated, v, true);
      set.insert(v);
    }
    const Snapshot snapshot(&grid, info());
    const VoxelIndex margin = VoxelIndex::Constant(70);
    const VoxelBox wide{grid.window().min - margin, grid.window().max + margin};
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE("seed 82, round " + std::to_string(round) + ", box " + std::to_string(i));
      const VoxelIndex a = test::uniformVoxel(random, wide), b = test::uniformVoxel(random, wide);
      const VoxelBox box = i == 0 ? wide : VoxelBox{a.cwiseMin(b), a.cwiseMax(b)};
      test::VoxelSet expected;
      std::copy_if(set.begin(), set.end(), std::inserter(expected, expected.end()),
                   [&](const VoxelIndex& v) { return box.contains(v); });
      const std::vector<VoxelIndex> voxels = snapshot.voxels(Plane::kInflated, box);
      ASSERT_EQ(test::VoxelSet(voxels.begin(), voxels.end()), expected);
      ASSERT_EQ(voxels.size(), expected.size());
      ASSERT_TRUE(std::is_sorted(
          voxels.begin(), voxels.end(), [](const VoxelIndex& p, const VoxelIndex& q) {
            return std::make_pair(p.x(), p.y()) < std::make_pair(q.x(), q.y());
          }));
    }
    ASSERT_TRUE(snapshot.voxels(Plane::kInflated, VoxelBox{{5, 5, 5}, {2, 9, 9}}).empty());
    ASSERT_TRUE(snapshot.voxels(Plane::kOccupied, wide).empty());
  }
}

TEST_P(SnapshotPropertyTest, StaysAsItWasWhileTheGridGoesOn) {
  test::Random random(83);
  SlidingGrid grid(GetParam());
  std::vector<Snapshot> snapshots;
  std::vector<test::VoxelField> states;
  for (int step = 0; step < 40; ++step) {
    ChangeSet changes;
    if (test::chance(random, 0.3)) {
      grid.moveTo(grid.window().min + test::randomSlide(random, GetParam()), &changes);
    }
    if (test::chance(random, 0.1)) grid.clear();
    for (int i = 0; i < 40; ++i) {
      grid.set(Plane::kOccupied, test::voxelNearFaces(random, grid.window()),
               test::chance(random, 0.7));
    }
    states.emplace_back(grid.window());
    grid.forEach(Plane::kOccupied, grid.window(),
                 [&](const VoxelIndex& v) { states.back().mark(v); });
    snapshots.emplace_back(&grid, info());
  }
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    ASSERT_EQ(snapshots[i].window(), states[i].box());
    ASSERT_EQ(snapshots[i].count(Plane::kOccupied), states[i].count());
    test::forEachVoxel(states[i].box(), [&](const VoxelIndex& v) {
      const Occupancy expected = states[i].at(v) ? Occupancy::kOccupied : Occupancy::kUnknown;
      ASSERT_EQ(snapshots[i].occupancy(v), expected) << "seed 83, step " << i;
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SnapshotPropertyTest,
                         ::testing::Values(VoxelIndex(1, 1, 1), VoxelIndex(9, 40, 20),
                                           VoxelIndex(33, 12, 64), VoxelIndex(3, 65, 70)));

}  // namespace
}  // namespace fiimap
