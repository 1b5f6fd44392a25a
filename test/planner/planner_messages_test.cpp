#include "planner_messages.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

constexpr double kQuarterTurn = 1.5707963267948966;  // rad

std_msgs::Header header() {
  std_msgs::Header h;
  h.frame_id = "map";
  h.stamp = ros::Time(12.5);
  return h;
}

TEST(PlannerMessagesTest, VelocityOfOdometryIsTurnedIntoTheMap) {
  nav_msgs::Odometry odometry;
  odometry.pose.pose.position.x = 4.0;
  odometry.pose.pose.orientation.z = std::sin(kQuarterTurn / 2);
  odometry.pose.pose.orientation.w = std::cos(kQuarterTurn / 2);
  odometry.twist.twist.linear.x = 2.0;
  const VehicleState state = toVehicleState(odometry);
  EXPECT_EQ(state.position, Eigen::Vector3d(4, 0, 0));
  EXPECT_LT((state.velocity - Eigen::Vector3d(0, 2, 0)).norm(), 1e-9);
  EXPECT_NEAR(state.yaw, kQuarterTurn, 1e-9);
  EXPECT_TRUE(isFinite(state));
}

TEST(PlannerMessagesTest, OdometryThatIsNotFiniteIsSeen) {
  nav_msgs::Odometry odometry;
  odometry.pose.pose.orientation.w = 1.0;
  EXPECT_TRUE(isFinite(toVehicleState(odometry)));
  odometry.pose.pose.position.z = std::nan("");
  EXPECT_FALSE(isFinite(toVehicleState(odometry)));
}

TEST(PlannerMessagesTest, ACommandIsOnePointInTheMapFrame) {
  const MotionState state{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const auto command = toCommand(state, kQuarterTurn, 0.5, header(), "base");
  EXPECT_EQ(command.header.frame_id, "map");
  EXPECT_EQ(command.header.stamp, ros::Time(12.5));
  ASSERT_EQ(command.joint_names, std::vector<std::string>{"base"});
  ASSERT_EQ(command.points.size(), 1u);
  const auto& point = command.points[0];
  ASSERT_EQ(point.transforms.size(), 1u);
  ASSERT_EQ(point.velocities.size(), 1u);
  ASSERT_EQ(point.accelerations.size(), 1u);
  EXPECT_EQ(point.transforms[0].translation.z, 3.0);
  EXPECT_NEAR(point.transforms[0].rotation.z, std::sin(kQuarterTurn / 2), 1e-9);
  EXPECT_NEAR(point.transforms[0].rotation.w, std::cos(kQuarterTurn / 2), 1e-9);
  EXPECT_EQ(point.velocities[0].linear.x, 4.0);
  EXPECT_EQ(point.velocities[0].angular.z, 0.5);
  EXPECT_EQ(point.accelerations[0].linear.y, 8.0);
}

TEST(PlannerMessagesTest, ATrajectoryIsSampledFromStartToRest) {
  Bspline::Points control;
  for (int i = 0; i < 10; ++i) control.emplace_back(0.0, 0.3 * i, 1.0);
  const Trajectory trajectory({control, 0.2}, 100.0);
  const auto message = toTrajectory(trajectory, header(), "base");
  EXPECT_EQ(message.header.stamp, ros::Time(100.0));
  ASSERT_GT(message.points.size(), 20u);
  const auto& last = message.points.back();
  EXPECT_NEAR(last.time_from_start.toSec(), 1.4, 1e-6);
  EXPECT_NEAR(last.transforms[0].translation.y, trajectory.at(101.4).position.y(), 1e-6);
  EXPECT_NEAR(message.points[1].transforms[0].rotation.w, std::cos(kQuarterTurn / 2), 1e-6);
}

TEST(PlannerMessagesTest, StatesHaveTheNumbersOfTheMessage) {
  const auto state = [](FlightState s) { return toStatus({s, "", 0, 0, 0, 0}, header()).state; };
  EXPECT_EQ(state(FlightState::kWaiting), PlannerStatus::WAITING);
  EXPECT_EQ(state(FlightState::kHovering), PlannerStatus::HOVERING);
  EXPECT_EQ(state(FlightState::kFlying), PlannerStatus::FLYING);
  EXPECT_EQ(state(FlightState::kBraking), PlannerStatus::BRAKING);
  EXPECT_EQ(state(FlightState::kNoPath), PlannerStatus::NO_PATH);
  EXPECT_EQ(state(FlightState::kGoalReached), PlannerStatus::GOAL_REACHED);
}

}  // namespace
}  // namespace fiimap
