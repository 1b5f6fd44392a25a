#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "fiimap/parameters.h"
#include "flight_space.h"

namespace fiimap {

/// What a trajectory may do, and how it is looked for. The ranges are in plannerParameters().
struct PlannerConfig {
  FlightRules rules;

  double max_speed = 2.0;         ///< m/s
  double max_acceleration = 3.0;  ///< m/s^2
  double max_braking = 4.0;       ///< m/s^2, deceleration along the way when it brakes
  double knot_interval = 0.2;     ///< s, between the knots of the B-spline
  double clearance = 0.1;  ///< m, that control points keep from obstacles they were pushed out of

  double planning_horizon = 10.0;  ///< m, way that is planned voxel by voxel
  int max_visited = 100000;        ///< voxels
  double max_escape = 1.5;         ///< m, way out of a place that is not free
};

/// When to plan, and when to give up. Used with a PlannerConfig.
struct FlightConfig {
  double replan_period = 0.5;    ///< s, at most, between plans while the goal is not yet planned to
  double braking_margin = 0.3;   ///< s, of time that is left before braking would be too late
  double goal_tolerance = 0.3;   ///< m
  double waypoint_radius = 1.0;  ///< m, at which a waypoint before the last one is passed
  double max_tracking_error = 1.0;  ///< m, between command and odometry
  /// Rad between the vehicle's heading and its way; at rest, with more it turns first.
  double turn_first_angle = 0.5;
  /// Rad to either side of the vehicle's heading that its sensor sees. It brakes before it gets to
  /// an unseen place that is farther to the side.
  double view_azimuth = 0.6;
};

/// The node around it.
struct PlannerNodeConfig {
  std::string map = "fiimap";     ///< name of the mapping nodelet, relative to the namespace
  double command_rate = 100.0;    ///< Hz
  double max_yaw_rate = 1.5;      ///< rad/s
  double odometry_timeout = 0.3;  ///< s
  double map_timeout = 1.0;       ///< s
  double goal_height = 1.0;       ///< m, of goals that come without a height: z = 0
  std::vector<Eigen::Vector3d> waypoints;
};

struct PlannerParameters {
  PlannerConfig planner;
  FlightConfig flight;
  PlannerNodeConfig node;
};

/// All parameters of the planner nodelet, bound to `parameters`, in the order of
/// config/planner.yaml.
std::vector<Parameter> plannerParameters(PlannerParameters* parameters);

/// Sets every parameter that `values` holds, and checks them together.
/// \return names in `values` that no parameter has.
/// \throws std::invalid_argument that names the parameter, its value and what is allowed.
std::vector<std::string> configure(const ParameterMap& values, PlannerParameters* parameters);

}  // namespace fiimap
