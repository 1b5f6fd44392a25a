#include "planner_messages.h"

#include <cmath>

#include <Eigen/Geometry>

#include "fiimap/ros/geometry_messages.h"

namespace fiimap {
namespace {

constexpr double kTrajectoryStep = 0.05;                                 // s
constexpr double kLineWidth = 0.05, kPathWidth = 0.03, kGoalSize = 0.4;  // m

geometry_msgs::Vector3 toVector(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 vector;
  vector.x = v.x();
  vector.y = v.y();
  vector.z = v.z();
  return vector;
}

trajectory_msgs::MultiDOFJointTrajectoryPoint toTrajectoryPoint(const MotionState& state,
                                                                double yaw, double yaw_rate) {
  trajectory_msgs::MultiDOFJointTrajectoryPoint point;
  point.transforms.resize(1);
  point.velocities.resize(1);
  point.accelerations.resize(1);
  point.transforms[0].translation = toVector(state.position);
  point.transforms[0].rotation.z = std::sin(yaw / 2.0);
  point.transforms[0].rotation.w = std::cos(yaw / 2.0);
  point.velocities[0].linear = toVector(state.velocity);
  point.velocities[0].angular.z = yaw_rate;
  point.accelerations[0].linear = toVector(state.acceleration);
  return point;
}

visualization_msgs::Marker marker(const std_msgs::Header& header, int id, int type, double size) {
  visualization_msgs::Marker m;
  m.header = header;
  m.ns = "planner";
  m.id = id;
  m.type = type;
  m.pose.orientation.w = 1.0;
  m.scale.x = m.scale.y = m.scale.z = size;
  m.color.a = 1.0f;
  return m;
}

/// Green, or vermilion while it brakes: told apart without a sense for red and green.
std_msgs::ColorRGBA lineColor(bool is_braking) {
  std_msgs::ColorRGBA color;
  color.r = is_braking ? 0.84f : 0.0f;
  color.g = is_braking ? 0.37f : 0.62f;
  color.b = is_braking ? 0.0f : 0.45f;
  color.a = 1.0f;
  return color;
}

/// Nothing to show takes away what was shown.
void hideWhenEmpty(visualization_msgs::Marker* m) {
  if (m->points.empty()) m->action = visualization_msgs::Marker::DELETE;
}

}  // namespace

VehicleState toVehicleState(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  const auto& v = odometry.twist.twist.linear;
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  const Eigen::Vector3d ahead = rotation * Eigen::Vector3d::UnitX();
  return {
      {p.x, p.y, p.z}, rotation * Eigen::Vector3d(v.x, v.y, v.z), std::atan2(ahead.y(), ahead.x())};
}

bool isFinite(const VehicleState& state) {
  return state.position.allFinite() && state.velocity.allFinite() && std::isfinite(state.yaw);
}

trajectory_msgs::MultiDOFJointTrajectory toCommand(const MotionState& state, double yaw,
                                                   double yaw_rate, const std_msgs::Header& header,
                                                   const std::string& body_frame) {
  trajectory_msgs::MultiDOFJointTrajectory command;
  command.header = header;
  command.joint_names = {body_frame};
  command.points.push_back(toTrajectoryPoint(state, yaw, yaw_rate));
  return command;
}

trajectory_msgs::MultiDOFJointTrajectory toTrajectory(const Trajectory& trajectory,
                                                      const std_msgs::Header& header,
                                                      const std::string& body_frame) {
  trajectory_msgs::MultiDOFJointTrajectory message;
  message.header = header;
  message.header.stamp = ros::Time(std::max(0.0, trajectory.startTime()));
  message.joint_names = {body_frame};
  double yaw = trajectory.heading().value_or(0.0);
  const double duration = trajectory.endTime() - trajectory.startTime();
  const int steps = static_cast<int>(std::ceil(duration / kTrajectoryStep));
  for (int i = 0; i <= steps; ++i) {
    const double time = std::min(i * kTrajectoryStep, duration);
    const MotionState state = trajectory.at(trajectory.startTime() + time);
    constexpr double kMoving = 0.05;  // m/s
    if (state.velocity.head<2>().norm() > kMoving) {
      yaw = std::atan2(state.velocity.y(), state.velocity.x());
    }
    message.points.push_back(toTrajectoryPoint(state, yaw, 0.0));
    message.points.back().time_from_start = ros::Duration(time);
  }
  return message;
}

nav_msgs::Path toPath(const std::vector<Eigen::Vector3d>& points, const std_msgs::Header& header) {
  nav_msgs::Path path;
  path.header = header;
  for (const Eigen::Vector3d& point : points) {
    path.poses.emplace_back();
    path.poses.back().header = header;
    path.poses.back().pose.position = toPoint(point);
    path.poses.back().pose.orientation.w = 1.0;
  }
  return path;
}

PlannerStatus toStatus(const FlightStatus& status, const std_msgs::Header& header) {
  constexpr double kMilliseconds = 1e3;
  PlannerStatus message;
  message.header = header;
  message.state = static_cast<std::uint8_t>(status.state);
  message.reason = status.reason;
  message.goal_distance = status.goal_distance;
  message.plans = status.plans;
  message.failures = status.failures;
  message.planning_ms = status.planning_time * kMilliseconds;
  return message;
}

visualization_msgs::MarkerArray toMarkers(const Flight& flight, double time,
                                          const std_msgs::Header& header) {
  using Marker = visualization_msgs::Marker;
  Marker line = marker(header, 0, Marker::LINE_STRIP, kLineWidth);
  if (flight.flown().current) {
    const Trajectory& last = flight.flown().last();
    for (double t = time; t < last.endTime() + kTrajectoryStep; t += kTrajectoryStep) {
      line.points.push_back(toPoint(flight.flown().at(t).at(t).position));
    }
    line.color = lineColor(last.isBraking());
  }
  Marker path = marker(header, 1, Marker::LINE_STRIP, kPathWidth);
  path.color.b = path.color.r = 1.0f;
  for (const Eigen::Vector3d& point : flight.plan().path) path.points.push_back(toPoint(point));
  Marker goals = marker(header, 2, Marker::SPHERE_LIST, kGoalSize);
  goals.color.r = goals.color.g = 1.0f;
  for (const Eigen::Vector3d& goal : flight.goals()) goals.points.push_back(toPoint(goal));

  visualization_msgs::MarkerArray all;
  for (Marker* m : {&line, &path, &goals}) {
    hideWhenEmpty(m);
    all.markers.push_back(*m);
  }
  return all;
}

}  // namespace fiimap
