#include "trajectory.h"

#include "planner_map.h"

namespace fiimap {
namespace {

constexpr double kInterval = 0.2;

/// Along x from rest to 2 m/s and on, to rest.
Bspline straightCurve() {
  Bspline::Points control(3, Eigen::Vector3d::Zero());
  double x = 0.0, step = 0.0;
  for (int i = 0; i < 40; ++i) {
    step = std::min({step + 0.08, 0.4, 0.08 * (39 - i)});
    control.emplace_back(x += step, 0.0, 0.0);
  }
  for (int i = 0; i < 2; ++i) control.push_back(control.back());
  return {control, kInterval};
}

Bspline windingCurve(test::Random& random) {
  Bspline::Points control = straightCurve().control();
  for (std::size_t i = 3; i + 3 < control.size(); ++i) {
    control[i].y() = test::uniformReal(random, -0.1, 0.1);
    control[i].z() = test::uniformReal(random, -0.1, 0.1);
  }
  return {control, kInterval};
}

TEST(TrajectoryTest, RestsAtItsEndAndWaitsAtItsStart) {
  const Trajectory trajectory(straightCurve(), 100.0);
  EXPECT_EQ(trajectory.at(90.0).position, Eigen::Vector3d::Zero());
  const Eigen::Vector3d end = trajectory.curve().control().back();
  EXPECT_NEAR((trajectory.at(trajectory.endTime() + 5.0).position - end).norm(), 0.0, 1e-9);
  EXPECT_EQ(trajectory.at(trajectory.endTime() + 5.0).velocity, Eigen::Vector3d::Zero());
}

TEST(TrajectoryTest, HoversWhereItIsTold) {
  const Eigen::Vector3d point(1, 2, 3);
  const Trajectory hover = Trajectory::hover(point, 5.0, 0.7);
  for (const double time : {4.0, 5.0, 5.05, 99.0}) {
    EXPECT_LT((hover.at(time).position - point).norm(), 1e-12);
    EXPECT_LT(hover.at(time).velocity.norm(), 1e-12);
  }
  EXPECT_EQ(hover.heading(), 0.7);
}

TEST(TrajectoryTest, BrakesOnItsWayWithoutAJumpWithinTheDeceleration) {
  test::Random random(541);
  constexpr double kDeceleration = 3.0, kStep = 0.005;
  for (int round = 0; round < 50; ++round) {
    const Trajectory flown(windingCurve(random), 10.0);
    const double time = test::uniformReal(random, 10.0, flown.endTime());
    const Trajectory braked = flown.braked(time, kDeceleration);
    SCOPED_TRACE("seed 541, round " + std::to_string(round));
    EXPECT_TRUE(braked.isBraking());
    EXPECT_EQ(braked.at(time - 0.1).position, flown.at(time - 0.1).position);
    EXPECT_LT((braked.at(time).position - flown.at(time).position).norm(), 1e-9);
    EXPECT_LT((braked.at(time).velocity - flown.at(time).velocity).norm(), 1e-9);
    EXPECT_LT(braked.at(braked.endTime()).velocity.norm(), 1e-6);
    double flown_time = time;
    for (double t = time; t < braked.endTime() - kStep; t += kStep) {
      const MotionState state = braked.at(t);
      const Eigen::Vector3d along = state.velocity.normalized();
      EXPECT_GE(state.acceleration.dot(along), -kDeceleration - flown.curve().accelerationBound());
      const Eigen::Vector3d moved = braked.at(t + kStep).position - state.position;
      EXPECT_LT((moved / kStep - state.velocity).norm(), 0.1);
      // It is a point of the way that was flown, further on.
      while (flown_time < flown.endTime() &&
             (flown.at(flown_time).position - state.position).norm() > 0.01) {
        flown_time += 0.001;
      }
      EXPECT_LT((flown.at(flown_time).position - state.position).norm(), 0.011);
    }
  }
}

TEST(TrajectoryTest, StopsWithinTheWayThatTheDecelerationNeeds) {
  const Trajectory flown(straightCurve(), 0.0);
  const double time = 3.0;
  const double speed = flown.at(time).velocity.norm();
  ASSERT_NEAR(speed, 2.0, 0.1);
  const Trajectory braked = flown.braked(time, 4.0);
  const double way = (braked.at(99.0).position - braked.at(time).position).norm();
  EXPECT_NEAR(way, speed * speed / (2.0 * 4.0), 0.05);
  EXPECT_NEAR(braked.endTime() - time, speed / 4.0, 0.05);
}

class FirstCollisionTest : public ::testing::Test {
 protected:
  FirstCollisionTest() : map_({200, 20, 20}, 0.1, 0.2) { map_.moveTo({-20, -10, -10}); }
  // What entered when the window moved is unknown, which is free here.
  test::PlannerMap map_;
  const Trajectory trajectory_{straightCurve(), 50.0};
};

TEST_F(FirstCollisionTest, IsNoneInFreeSpace) {
  EXPECT_FALSE(firstCollision(trajectory_, map_.space(), {50.0}, 1.0));
  EXPECT_FALSE(firstCollision(trajectory_, map_.space(), {999.0}, 1.0));
}

TEST_F(FirstCollisionTest, IsWhenTheInflatedObstacleIsReached) {
  map_.occupy(VoxelIndex(50, 0, 0));  // inflated from 4.8 m on
  const std::optional<double> time = firstCollision(trajectory_, map_.space(), {50.0}, 1.0);
  ASSERT_TRUE(time);
  EXPECT_NEAR(trajectory_.at(*time).position.x(), 4.8, 0.06);
  // Behind it, all is well.
  double behind = *time;
  while (trajectory_.at(behind).position.x() < 5.4) behind += 0.01;
  EXPECT_FALSE(firstCollision(trajectory_, map_.space(), {behind}, 1.0));
  // One that brakes in time does not get there.
  EXPECT_FALSE(firstCollision(trajectory_.braked(*time - 1.0, 4.0), map_.space(), {50.0}, 1.0));
}

TEST_F(FirstCollisionTest, AHoverCollidesWhenAnObstacleAppearsAround) {
  const Trajectory hover = Trajectory::hover({5.05, 0.05, 0.05}, 50.0);
  EXPECT_FALSE(firstCollision(hover, map_.space(), {999.0}, 1.0));
  map_.occupy(VoxelIndex(51, 0, 0));
  EXPECT_TRUE(firstCollision(hover, map_.space(), {999.0}, 1.0));
}

TEST_F(FirstCollisionTest, AWayOutOfInflatedSpaceMustBeShortAndCrossNoOccupiedVoxel) {
  map_.occupy(VoxelBox{{-3, 1, -1}, {7, 2, 1}});  // beside the way, inflated over its beginning
  const FlightSpace space = map_.space();
  ASSERT_FALSE(space.isFree(Eigen::Vector3d(0.0, 0.0, 0.0)));
  EXPECT_FALSE(firstCollision(trajectory_, space, {50.0}, 1.5));
  EXPECT_TRUE(firstCollision(trajectory_, space, {50.0}, 0.5));
  map_.occupy(VoxelIndex(5, 0, 0));
  EXPECT_TRUE(firstCollision(trajectory_, map_.space(), {50.0}, 1.5));
}

}  // namespace
}  // namespace fiimap
