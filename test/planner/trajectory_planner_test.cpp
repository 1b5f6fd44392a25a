#include "trajectory_planner.h"

#include "planner_map.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.1;
constexpr double kStep = 0.002;  // s

/// What every accepted trajectory promises, by dense sampling.
void expectFlyable(const Trajectory& trajectory, const FlightSpace& space,
                   const PlannerConfig& config, const MotionState& start) {
  const double begin = trajectory.startTime();
  const MotionState first = trajectory.at(begin);
  EXPECT_LT((first.position - start.position).norm(), 1e-6);
  EXPECT_LT((first.velocity - start.velocity).norm(), 1e-6);
  EXPECT_LT((first.acceleration - start.acceleration).norm(), 1e-6);
  const double max_speed = std::max(config.max_speed, start.velocity.norm());
  const double max_acceleration = std::max(config.max_acceleration, start.acceleration.norm());
  bool was_free = false;
  for (double time = begin; time < trajectory.endTime() + kStep; time += kStep) {
    const MotionState state = trajectory.at(time);
    EXPECT_LE(state.velocity.norm(), max_speed + 1e-4);
    EXPECT_LE(state.acceleration.norm(), max_acceleration + 1e-3);
    const bool is_free = space.isFree(state.position);
    EXPECT_TRUE(is_free || !was_free) << state.position.transpose();
    if (!is_free) {
      EXPECT_TRUE(space.isCrossable(space.lattice().indexOf(state.position)));
    }
    was_free = was_free || is_free;
  }
  EXPECT_TRUE(was_free);
  EXPECT_LT(trajectory.at(trajectory.endTime()).velocity.norm(), 1e-6);
}

struct Forest {
  Forest(unsigned seed, double radius) : map({200, 200, 30}, kResolution, radius) {
    test::Random random(seed);
    test::scatter(random, 60, 40, &map);
  }
  test::PlannerMap map;
};

class TrajectoryPlannerTest : public ::testing::TestWithParam<double> {};

TEST_P(TrajectoryPlannerTest, FliesThroughForests) {
  PlannerConfig config;
  config.max_speed = GetParam();
  TrajectoryPlanner planner(config);
  int plans = 0, wanted = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE("forest " + std::to_string(seed));
    Forest forest(seed, 0.3);
    const FlightSpace space = forest.map.space();
    test::Random random(1000 + seed);
    MotionState start;
    start.position = {test::uniformReal(random, -9, -5), test::uniformReal(random, -9, 9), 0.05};
    const Eigen::Vector3d goal(test::uniformReal(random, 5, 9), test::uniformReal(random, -9, 9),
                               0.0);
    if (!space.isFree(start.position) || !space.isFree(goal)) continue;
    const Plan plan = planner.plan(space, start, 7.0, goal);
    if (plan.end != PathEnd::kGoal && plan.end != PathEnd::kBorder) continue;
    ++wanted;
    if (!plan.trajectory) continue;
    ++plans;
    EXPECT_EQ(plan.trajectory->startTime(), 7.0);
    expectFlyable(*plan.trajectory, space, config, start);
  }
  RecordProperty("plans", plans);
  std::cout << GetParam() << " m/s: " << plans << " of " << wanted << " plans\n";
  EXPECT_GE(wanted, 5);
  EXPECT_EQ(plans, wanted);
}

INSTANTIATE_TEST_SUITE_P(Speeds, TrajectoryPlannerTest, ::testing::Values(1.0, 2.0, 4.0));

TEST(TrajectoryPlannerRestTest, WhereAPathLeadsThereIsATrajectoryFromRestAtAnySpeed) {
  int plans = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    test::Random random(3000 + seed);
    PlannerConfig config;
    config.max_speed = test::uniformReal(random, 2.0, 12.0);
    config.max_acceleration = test::uniformReal(random, 0.5, 4.0);
    config.knot_interval = test::uniformReal(random, 0.1, 0.6);
    SCOPED_TRACE("forest " + std::to_string(seed));
    test::PlannerMap map({160, 160, 20}, kResolution, 0.4);
    test::scatter(random, 80, 40, &map);
    const FlightSpace space = map.space();
    MotionState start;
    start.position = {test::uniformReal(random, -7, 0), test::uniformReal(random, -7, 7), 0.05};
    if (!space.isFree(start.position)) continue;
    const Plan plan = TrajectoryPlanner(config).plan(space, start, 0.0, {7.0, 0.0, 0.0});
    if (plan.end == PathEnd::kNowhere) continue;
    ASSERT_TRUE(plan.trajectory) << config.max_speed << " m/s";
    expectFlyable(*plan.trajectory, space, config, start);
    ++plans;
  }
  EXPECT_GE(plans, 12);
}

TEST(TrajectoryPlannerReplanTest, GoesOnFromAnyMomentOfATrajectory) {
  const PlannerConfig config;
  TrajectoryPlanner planner(config);
  int plans = 0, wanted = 0;
  for (unsigned seed = 0; seed < 7; ++seed) {
    SCOPED_TRACE("forest " + std::to_string(seed));
    Forest forest(seed, 0.3);
    const FlightSpace space = forest.map.space();
    MotionState start;
    start.position = {-8.0, 0.05, 0.05};
    if (!space.isFree(start.position)) continue;
    const Plan first = planner.plan(space, start, 0.0, {8.0, 0.0, 0.0});
    if (!first.trajectory) continue;
    test::Random random(2000 + seed);
    for (int i = 0; i < 5; ++i) {
      // At a knot, as in flight, to another goal.
      const double time = config.knot_interval * test::uniformInt(random, 1, 15);
      const MotionState state = first.trajectory->at(time);
      const Plan plan =
          planner.plan(space, state, time, {8.0, test::uniformReal(random, -8, 8), 0.0});
      ++wanted;
      if (!plan.trajectory) continue;
      ++plans;
      expectFlyable(*plan.trajectory, space, config, state);
    }
  }
  std::cout << plans << " of " << wanted << " plans\n";
  EXPECT_GE(wanted, 20);
  // A vehicle that flies into a turn may be too fast for it: then it goes on as before.
  EXPECT_GE(plans, wanted * 8 / 10);
}

TEST(TrajectoryPlannerGuideTest, LeavesADeadEndThatIsDeeperThanTheHorizon) {
  PlannerConfig config;
  config.planning_horizon = 3.0;
  TrajectoryPlanner planner(config);
  // A pocket of 12 x 4 m that is open at the side away from the goal.
  test::PlannerMap map({300, 200, 30}, kResolution, 0.3);
  map.occupy(VoxelBox{{60, -20, -15}, {62, 20, 15}});
  map.occupy(VoxelBox{{-60, -20, -15}, {60, -18, 15}});
  map.occupy(VoxelBox{{-60, 18, -15}, {60, 20, 15}});
  const FlightSpace space = map.space();
  MotionState state;
  state.position = {5.0, 0.05, 0.05};
  const Eigen::Vector3d goal(9.0, 0.0, 0.0);
  Plan plan;
  // Each plan leads on along the way by about the horizon.
  for (int i = 0; i < 20 && plan.end != PathEnd::kGoal; ++i) {
    plan = planner.plan(space, state, 0.0, goal);
    ASSERT_TRUE(plan.trajectory);
    expectFlyable(*plan.trajectory, space, config, state);
    state.position = plan.trajectory->at(plan.trajectory->endTime()).position;
  }
  EXPECT_EQ(plan.end, PathEnd::kGoal);
}

TEST(TrajectoryPlannerGuideTest, FindsAGapThatIsNarrowerThanTheGuide) {
  const PlannerConfig config;
  TrajectoryPlanner planner(config);
  test::PlannerMap map({120, 120, 10}, kResolution, 0.0);
  for (int gap = -4; gap < 5; ++gap) {
    SCOPED_TRACE("gap at " + std::to_string(gap));
    map.clear();
    map.occupy(VoxelBox{{0, -60, -5}, {2, gap, 5}});
    map.occupy(VoxelBox{{0, gap + 1, -5}, {2, 60, 5}});
    MotionState start;
    start.position = {-3.0, 0.05, 0.05};
    const Plan plan = planner.plan(map.space(), start, 0.0, {3.0, 0.05, 0.05});
    EXPECT_EQ(plan.end, PathEnd::kGoal);
  }
}

TEST(TrajectoryPlannerStartTest, GetsOutOfInflatedSpace) {
  const PlannerConfig config;
  TrajectoryPlanner planner(config);
  test::PlannerMap map({200, 60, 30}, kResolution, 0.5);
  map.occupy(VoxelBox{{0, -30, -15}, {1, 30, 15}});
  const FlightSpace space = map.space();
  MotionState start;
  start.position = {-0.25, 0.05, 0.05};
  ASSERT_FALSE(space.isFree(start.position));
  const Plan plan = planner.plan(space, start, 0.0, {-4.0, 0.0, 0.0});
  ASSERT_TRUE(plan.trajectory);
  EXPECT_EQ(plan.end, PathEnd::kGoal);
  expectFlyable(*plan.trajectory, space, config, start);
}

TEST(TrajectoryPlannerStartTest, DoesNotGoThroughTheWallToGetOut) {
  TrajectoryPlanner planner({});
  test::PlannerMap map({200, 60, 30}, kResolution, 0.5);
  map.occupy(VoxelBox{{0, -30, -15}, {1, 30, 15}});
  const FlightSpace space = map.space();
  MotionState start;
  start.position = {-0.25, 0.05, 0.05};
  const Plan plan = planner.plan(space, start, 0.0, {4.0, 0.0, 0.0});
  ASSERT_TRUE(plan.trajectory);
  EXPECT_EQ(plan.end, PathEnd::kNearest);
  for (double time = 0.0; time < plan.trajectory->endTime(); time += kStep) {
    EXPECT_LT(plan.trajectory->at(time).position.x(), 0.0);
  }
}

TEST(TrajectoryPlannerStartTest, ThereIsNoPlanFromInsideOfAnObstacleOrFromOutsideOfTheWindow) {
  TrajectoryPlanner planner({});
  test::PlannerMap map({60, 60, 30}, kResolution, 0.0);
  map.occupy(VoxelBox{{-30, -30, -15}, {0, 30, 15}});
  MotionState inside, outside;
  inside.position = {-2.5, 0.0, 0.0};
  outside.position = {50.0, 0.0, 0.0};
  EXPECT_FALSE(planner.plan(map.space(), inside, 0.0, {2.0, 0.0, 0.0}).trajectory);
  EXPECT_FALSE(planner.plan(map.space(), outside, 0.0, {2.0, 0.0, 0.0}).trajectory);
}

TEST(TrajectoryPlannerStartTest, KeepsOutOfTheUnknownWhenItIsAnObstacle) {
  test::PlannerMap map({100, 60, 30}, kResolution, 0.0);
  map.forget(VoxelBox{{20, -30, -15}, {50, 30, 15}});
  PlannerConfig config;
  TrajectoryPlanner planner(config);
  const Plan bold = planner.plan(map.space(), {}, 0.0, {4.0, 0.0, 0.0});
  ASSERT_TRUE(bold.trajectory);
  EXPECT_EQ(bold.end, PathEnd::kGoal);
  FlightRules careful;
  careful.unknown = Unseen::kObstacle;
  const FlightSpace space = map.space(careful);
  const Plan plan = planner.plan(space, {}, 0.0, {4.0, 0.0, 0.0});
  ASSERT_TRUE(plan.trajectory);
  EXPECT_EQ(plan.end, PathEnd::kNearest);
  EXPECT_NEAR(plan.trajectory->at(99.0).position.x(), 1.95, 0.06);
  expectFlyable(*plan.trajectory, space, config, {});
}

}  // namespace
}  // namespace fiimap
