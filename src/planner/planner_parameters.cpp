#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "planner_config.h"

namespace fiimap {
namespace {

constexpr double kMaxSpeed = 50.0, kMinSpeed = 0.05;                // m/s
constexpr double kMaxAcceleration = 100.0, kMinAcceleration = 0.1;  // m/s^2
constexpr double kMaxCoordinate = 1e7;                              // m
constexpr double kPi = 3.14159265358979323846;

/// Points as one list of numbers: x y z x y z ...
Parameter pointsParameter(const std::string& name, std::vector<Eigen::Vector3d>* field,
                          const std::string& unit, const std::string& meaning) {
  const std::string allowed = "a list of numbers, x y z of each point, each at most 1e7 m";
  const auto get = [field] {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(std::numeric_limits<double>::digits10);
    for (const Eigen::Vector3d& point : *field) {
      for (int axis = 0; axis < 3; ++axis) text << (text.tellp() > 0 ? " " : "") << point[axis];
    }
    return text.str();
  };
  const auto set = [=](const std::string& text) {
    std::string numbers = text;
    for (const char separator : {'[', ',', ']'}) {
      std::replace(numbers.begin(), numbers.end(), separator, ' ');
    }
    std::istringstream stream(numbers);
    stream.imbue(std::locale::classic());
    std::vector<double> values;
    for (double value = 0.0; stream >> value;) values.push_back(value);
    const bool in_range = std::all_of(values.begin(), values.end(), [](double value) {
      return std::abs(value) <= kMaxCoordinate;
    });
    if (!stream.eof() || values.size() % 3 != 0 || !in_range) {
      throw std::invalid_argument("parameter " + name + " = '" + text + "': must be " + allowed);
    }
    field->clear();
    for (std::size_t i = 0; i < values.size(); i += 3) {
      field->emplace_back(values[i], values[i + 1], values[i + 2]);
    }
  };
  return {name, unit, allowed, meaning, get, set};
}

std::vector<Parameter> spaceParameters(PlannerConfig* c) {
  const std::vector<std::string> unseen{"obstacle", "free"};
  return {
      choiceParameter("layer", &c->rules.layer, {"inflated", "raw"},
                      "which layer of the map to keep out of; raw knows no vehicle size"),
      choiceParameter("unknown", &c->rules.unknown, unseen, "what voxels never seen are taken for"),
      choiceParameter("outside", &c->rules.outside, unseen,
                      "what everything outside of the map's window is taken for"),
      numberParameter("view_elevation", &c->rules.view_elevation, 0.0, kPi / 2.0, "rad",
                      "above and below the vehicle's horizon, beyond which voxels never seen are "
                      "obstacles all the same"),
      numberParameter("planning_horizon", &c->planning_horizon, 0.5, 1000.0, "m",
                      "how long a way is planned and checked voxel by voxel"),
      integerParameter("max_visited", &c->max_visited, 100, 10000000, "voxels",
                       "a search ends after looking around from so many voxels"),
      numberParameter("max_escape", &c->max_escape, 0.0, 100.0, "m",
                      "largest way out of inflated or unknown space that a flight may begin with"),
  };
}

std::vector<Parameter> motionParameters(PlannerConfig* c) {
  return {
      numberParameter("max_speed", &c->max_speed, kMinSpeed, kMaxSpeed, "m/s",
                      "speed that no trajectory exceeds"),
      numberParameter("max_acceleration", &c->max_acceleration, kMinAcceleration, kMaxAcceleration,
                      "m/s^2", "acceleration that no trajectory exceeds but when it brakes"),
      numberParameter("max_braking", &c->max_braking, kMinAcceleration, kMaxAcceleration, "m/s^2",
                      "deceleration along the way when it brakes"),
      numberParameter("knot_interval", &c->knot_interval, 0.02, 2.0, "s",
                      "time between two knots of the B-spline"),
      numberParameter("clearance", &c->clearance, 0.0, 10.0, "m",
                      "how far control points are pushed beyond the surface of obstacles"),
  };
}

std::vector<Parameter> flightParameters(FlightConfig* c) {
  return {
      numberParameter("replan_period", &c->replan_period, 0.02, 60.0, "s",
                      "time between plans while what is flown does not end at the goal"),
      numberParameter("braking_margin", &c->braking_margin, 0.0, 60.0, "s",
                      "how long before it is too late to brake it brakes"),
      numberParameter("goal_tolerance", &c->goal_tolerance, 0.01, 100.0, "m",
                      "distance at which the goal is reached"),
      numberParameter("waypoint_radius", &c->waypoint_radius, 0.01, 1000.0, "m",
                      "distance at which a waypoint before the last one is passed"),
      numberParameter("max_tracking_error", &c->max_tracking_error, 0.01, 1000.0, "m",
                      "distance of the vehicle from its command at which the flight starts anew "
                      "from where the vehicle is"),
      numberParameter("turn_first_angle", &c->turn_first_angle, 0.0, kPi, "rad",
                      "a vehicle at rest turns first when its way leads more to the side"),
      numberParameter(
          "view_azimuth", &c->view_azimuth, 0.0, kPi, "rad",
          "to either side of the heading; it brakes before unseen places farther aside"),
  };
}

std::vector<Parameter> nodeParameters(PlannerNodeConfig* c) {
  return {
      textParameter("map", &c->map, "name of the mapping nodelet, in the same manager"),
      numberParameter("command_rate", &c->command_rate, 1.0, 1000.0, "Hz", "rate of commands"),
      numberParameter("max_yaw_rate", &c->max_yaw_rate, 0.01, 100.0, "rad/s",
                      "how fast the commanded heading turns"),
      numberParameter("odometry_timeout", &c->odometry_timeout, 0.01, 60.0, "s",
                      "without odometry for so long the vehicle brakes"),
      numberParameter("map_timeout", &c->map_timeout, 0.01, 60.0, "s",
                      "without a new snapshot for so long the vehicle brakes"),
      numberParameter("goal_height", &c->goal_height, -kMaxCoordinate, kMaxCoordinate, "m",
                      "height of goals whose z is 0, as rviz's 2D tool gives them"),
      pointsParameter("waypoints", &c->waypoints, "m", "points to fly to from the start"),
  };
}

}  // namespace

std::vector<Parameter> plannerParameters(PlannerParameters* parameters) {
  std::vector<Parameter> all = spaceParameters(&parameters->planner);
  for (const auto& group :
       {motionParameters(&parameters->planner), flightParameters(&parameters->flight),
        nodeParameters(&parameters->node)}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

std::vector<std::string> configure(const ParameterMap& values, PlannerParameters* parameters) {
  const std::vector<std::string> unknown = applyParameters(values, plannerParameters(parameters));
  if (parameters->node.map.empty()) {
    throw std::invalid_argument("parameter map = '': must be the name of the mapping nodelet");
  }
  return unknown;
}

}  // namespace fiimap
