#include "flight_space.h"

#include <cmath>
#include <limits>

#include "planner_map.h"

namespace fiimap {
namespace {

constexpr double kSpaceResolution = 0.5;
const VoxelIndex kObstacle(2, 2, 2), kInflated(2, 2, 1), kUnknown(-3, 0, 0), kFree(0, 0, 0),
    kOutside(4, 0, 0);

class FlightSpaceTest : public ::testing::Test {
 protected:
  FlightSpaceTest() : map_({8, 8, 8}, kSpaceResolution, 0.5) {
    map_.occupy(kObstacle);
    map_.forget({kUnknown, kUnknown + VoxelIndex::Ones()});
  }
  test::PlannerMap map_;
};

TEST_F(FlightSpaceTest, TheLayerDecidesWhatIsAnObstacle) {
  const FlightSpace inflated = map_.space({MapLayer::kInflated});
  const FlightSpace raw = map_.space({MapLayer::kRaw});
  EXPECT_TRUE(inflated.isFree(kFree));
  EXPECT_FALSE(inflated.isFree(kObstacle));
  EXPECT_FALSE(inflated.isFree(kInflated));
  EXPECT_TRUE(raw.isFree(kFree));
  EXPECT_FALSE(raw.isFree(kObstacle));
  EXPECT_TRUE(raw.isFree(kInflated));
  EXPECT_TRUE(inflated.isCrossable(kInflated));
  EXPECT_FALSE(inflated.isCrossable(kObstacle));
}

TEST_F(FlightSpaceTest, WhatIsNotSeenIsWhatTheUserChose) {
  for (const MapLayer layer : {MapLayer::kInflated, MapLayer::kRaw}) {
    for (const Unseen unknown : {Unseen::kObstacle, Unseen::kFree}) {
      for (const Unseen outside : {Unseen::kObstacle, Unseen::kFree}) {
        const FlightSpace space = map_.space({layer, unknown, outside});
        EXPECT_EQ(space.isFree(kUnknown), unknown == Unseen::kFree);
        EXPECT_EQ(space.isFree(kOutside), outside == Unseen::kFree);
        EXPECT_EQ(space.isCrossable(kOutside), outside == Unseen::kFree);
        EXPECT_TRUE(space.isCrossable(kUnknown));
      }
    }
  }
}

TEST(FlightSpaceViewTest, UnseenPlacesAreFreeWhereTheVehicleLooks) {
  test::Random random(541);
  test::PlannerMap map({30, 30, 30}, kSpaceResolution, 0.0);
  map.forget(map.window());
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE("seed 541, round " + std::to_string(round));
    FlightRules rules;
    rules.view_elevation = test::uniformReal(random, 0.0, 1.5);
    const Eigen::Vector3d vehicle =
        Eigen::Vector3d::NullaryExpr([&] { return test::uniformReal(random, -7.0, 7.0); });
    const FlightSpace space = map.space(rules, vehicle);
    const VoxelIndex v = test::uniformVoxel(random, map.window());
    const Eigen::Vector3d offset = space.lattice().centerOf(v) - vehicle;
    const double climb = std::abs(offset.z()) - 1.5 * kSpaceResolution;  // less counts as level
    const double elevation = std::atan2(climb, offset.head<2>().norm());
    EXPECT_EQ(space.isFree(v), climb <= 0.0 || elevation <= rules.view_elevation);
  }
  FlightRules everywhere;
  everywhere.view_elevation = M_PI / 2.0;
  EXPECT_TRUE(map.space(everywhere).isFree(VoxelIndex(0, 0, 12)));
  EXPECT_FALSE(map.space().isFree(VoxelIndex(0, 0, 12)));
}

TEST_F(FlightSpaceTest, AVoxelThatAWallCutsIsNotFree) {
  map_.walls() = {-0.75, 1.0};  // the floor cuts voxel -2, the ceiling ends voxel 1
  const FlightSpace space = map_.space();
  EXPECT_FALSE(space.isFree(VoxelIndex(0, 0, -2)));
  EXPECT_TRUE(space.isFree(VoxelIndex(0, 0, -1)));
  EXPECT_TRUE(space.isFree(VoxelIndex(0, 0, 1)));
  EXPECT_FALSE(space.isFree(VoxelIndex(0, 0, 2)));
}

TEST_F(FlightSpaceTest, PointsThatAreNotFiniteAreNotFree) {
  const FlightSpace space = map_.space({MapLayer::kInflated, Unseen::kFree, Unseen::kFree});
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    const Eigen::Vector3d point(0.0, bad, 0.0);
    EXPECT_FALSE(space.isFree(point));
    EXPECT_FALSE(space.isLineFree(point, Eigen::Vector3d::Zero()));
    EXPECT_FALSE(space.isLineFree(Eigen::Vector3d::Zero(), point));
  }
}

TEST_F(FlightSpaceTest, ALineIsFreeWhenItMissesAllObstacles) {
  const FlightSpace space = map_.space();
  const Eigen::Vector3d from = space.lattice().centerOf({-1, 2, 2});
  EXPECT_TRUE(space.isLineFree(from, space.lattice().centerOf({0, 2, 2})));
  EXPECT_FALSE(space.isLineFree(from, space.lattice().centerOf({3, 2, 2})));
}

}  // namespace
}  // namespace fiimap
