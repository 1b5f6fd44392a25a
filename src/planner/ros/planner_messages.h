#pragma once

#include <fiimap/PlannerStatus.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <std_msgs/Header.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>
#include <visualization_msgs/MarkerArray.h>

#include "flight.h"

namespace fiimap {

/// Velocities of an odometry message are in the frame of the body.
VehicleState toVehicleState(const nav_msgs::Odometry& odometry);
bool isFinite(const VehicleState& state);

/// One point, in the map frame. \param yaw rad; \param yaw_rate rad/s.
trajectory_msgs::MultiDOFJointTrajectory toCommand(const MotionState& state, double yaw,
                                                   double yaw_rate, const std_msgs::Header& header,
                                                   const std::string& body_frame);

/// From the start of the trajectory to rest, in equal steps of time; the heading is that of the
/// way.
trajectory_msgs::MultiDOFJointTrajectory toTrajectory(const Trajectory& trajectory,
                                                      const std_msgs::Header& header,
                                                      const std::string& body_frame);

nav_msgs::Path toPath(const std::vector<Eigen::Vector3d>& points, const std_msgs::Header& header);

PlannerStatus toStatus(const FlightStatus& status, const std_msgs::Header& header);

/// What is flown as a line (red: it brakes), the search's path, and the goals.
visualization_msgs::MarkerArray toMarkers(const Flight& flight, double time,
                                          const std_msgs::Header& header);

}  // namespace fiimap
