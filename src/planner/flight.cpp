#include "flight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fiimap {
namespace {

constexpr double kMinLead = 0.1;     // s, from an attempt to plan to the start of its trajectory
constexpr double kLeadFactor = 2.0;  // times what the last attempt took
constexpr double kMaxLead = 2.0;     // s
constexpr double kResting = 0.05;    // m/s
constexpr double kProgress = 0.1;    // m, that a plan must lead elsewhere to be worth flying
constexpr double kLookAhead = 1.0;   // m, of way to see where it leads
constexpr double kRestTime = 0.2;    // s, after braking: commands are sent at their own moments
constexpr double kBlindStep = 0.02;  // s, between places that are looked at
constexpr double kOwnPlace = 0.2;    // m, around the vehicle, which need not be seen
constexpr double kTurned = 0.2;      // rad, to a heading that it was to turn to

double angleBetween(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * M_PI)); }

/// Where a trajectory leads to; none: nowhere but up or down.
std::optional<double> headingOf(const Trajectory& trajectory) {
  const Eigen::Vector3d start = trajectory.at(trajectory.startTime()).position;
  constexpr int kSamples = 100;
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (int i = 1; i <= kSamples && way.head<2>().norm() < kLookAhead; ++i) {
    const double share = static_cast<double>(i) / kSamples;
    way = trajectory
              .at(trajectory.startTime() + share * (trajectory.endTime() - trajectory.startTime()))
              .position -
          start;
  }
  if (way.head<2>().norm() < kProgress) return std::nullopt;
  return std::atan2(way.y(), way.x());
}

}  // namespace

Flight::Flight(const PlannerConfig& planner, const FlightConfig& config, Clock clock)
    : planner_config_(planner), config_(config), clock_(std::move(clock)), planner_(planner) {}

void Flight::setGoals(const std::vector<Eigen::Vector3d>& goals) {
  goals_.assign(goals.begin(), goals.end());
  goal_is_new_ = true;
  ends_at_goal_ = false;
  looked_around_ = 0.0;
  if (status_.state == FlightState::kGoalReached) set(FlightState::kHovering, "has a new goal");
}

void Flight::restart() {
  flown_ = {};
  space_.reset();
  ends_at_goal_ = false;
  last_attempt_ = -std::numeric_limits<double>::infinity();
}

/// Whether its rest may not have been commanded yet.
bool Flight::hasJustBraked(double time) const {
  return status_.state == FlightState::kBraking && flown_.current &&
         !flown_.rests(time - kRestTime);
}

void Flight::step(const FlightInput& input) {
  if (flown_.current) flown_.advance(input.time);
  const std::string& trouble =
      input.odometry_trouble.empty() ? input.map_trouble : input.odometry_trouble;
  if (!trouble.empty()) {
    if (flown_.current && !flown_.rests(input.time)) {
      brake(trouble);
    } else if (!hasJustBraked(input.time)) {
      set(FlightState::kWaiting, trouble);
      // Nobody knows where the vehicle is: a place to keep would be a guess.
      if (!input.odometry_trouble.empty()) flown_ = {};
    }
    return;
  }
  if (input.snapshot && (!space_ || &space_->snapshot() != input.snapshot.get())) {
    space_.emplace(input.snapshot, planner_config_.rules, input.vehicle.position);
  }
  followVehicle(input);
  passGoals(input);
  if (goals_.empty()) {
    if (status_.state != FlightState::kGoalReached) set(FlightState::kHovering, "no goal");
    return;
  }
  flyTo(goals_.front(), input);
}

void Flight::followVehicle(const FlightInput& input) {
  const VehicleState& vehicle = input.vehicle;
  if (flown_.current) {
    const Eigen::Vector3d commanded = flown_.at(input.time).at(input.time).position;
    if ((commanded - vehicle.position).norm() <= config_.max_tracking_error) return;
  }
  const MotionState start{vehicle.position, vehicle.velocity, Eigen::Vector3d::Zero()};
  flown_ = {
      std::make_shared<const Trajectory>(vehicle.velocity.norm() > kResting
                                             ? planner_.stop(start, input.time)
                                             : Trajectory::hover(vehicle.position, input.time)),
      nullptr};
  ends_at_goal_ = false;
}

void Flight::passGoals(const FlightInput& input) {
  if (goals_.empty()) return;
  double distance = (goals_.front() - input.vehicle.position).norm();
  while (goals_.size() > 1 && distance <= config_.waypoint_radius) {
    goals_.pop_front();
    goal_is_new_ = true;
    ends_at_goal_ = false;
    distance = (goals_.front() - input.vehicle.position).norm();
  }
  status_.goal_distance = distance;
  if (goals_.size() == 1 && distance <= config_.goal_tolerance && flown_.rests(input.time)) {
    goals_.clear();
    set(FlightState::kGoalReached, "");
  }
}

void Flight::flyTo(const Eigen::Vector3d& goal, const FlightInput& input) {
  const std::optional<double> collision = nextCollision(input);
  if (input.snapshot && wantsPlan(input.time, collision.has_value())) {
    planTo(goal, input, collision);
  }
  const bool rests = flown_.rests(input.time);
  const bool avoided = collision && flown_.next && !nextCollision(input);
  if (collision && !avoided && !rests) {
    const double left = *collision - clock_();
    if (left <= timeToBrake(input.time) + config_.braking_margin + status_.planning_time) {
      brake(left > timeToBrake(input.time) ? "an obstacle is ahead and there is no way around it"
                                           : "an obstacle appeared too near to stop before it");
      return;
    }
  }
  if (!rests) {
    const bool braking = !flown_.next && flown_.current->isBraking();
    if (!braking && fliesBlindly(input)) {
      brake("it would get to where it did not look yet");
      return;
    }
    if (!braking) set(FlightState::kFlying, collision ? "looks for a way around an obstacle" : "");
  }
}

bool Flight::wantsPlan(double time, bool collides) const {
  if (flown_.next) return false;
  if (goal_is_new_ || (collides && !flown_.rests(time))) return true;
  const double pause = std::max(config_.replan_period, kLeadFactor * status_.planning_time);
  return (collides || !ends_at_goal_) && time - last_attempt_ >= pause;
}

double Flight::planStart(double time) const {
  const double lead = std::clamp(kLeadFactor * status_.planning_time, kMinLead, kMaxLead);
  const Trajectory& flown = *flown_.current;
  // At a knot, the first control points of the new curve are those of the flown one.
  const double interval = flown.curve().interval();
  const double knots = std::ceil((time + lead - flown.startTime()) / interval);
  return flown.isBraking() ? time + lead : flown.startTime() + knots * interval;
}

void Flight::planTo(const Eigen::Vector3d& goal, const FlightInput& input,
                    std::optional<double> collision) {
  const double start_time = planStart(input.time);
  const bool rests = flown_.rests(input.time);
  // There is no point in a plan from where the vehicle must not get to.
  if (collision && !rests && start_time >= *collision) return;
  const MotionState start = flown_.current->at(start_time);
  last_attempt_ = input.time;
  goal_is_new_ = false;
  plan_ = planner_.plan(*space_, start, start_time, goal);
  const double now = clock_();
  status_.planning_time = now - input.time;

  const bool late = !rests && now > start_time;
  if (!plan_.trajectory || late) {
    ++status_.failures;
    if (rests) {
      set(FlightState::kNoPath, plan_.end == PathEnd::kNowhere
                                    ? "the vehicle is inside of an obstacle or outside of the map"
                                    : "no trajectory holds the limits");
      lookAround(input);
    }
    return;
  }
  const Eigen::Vector3d end = plan_.trajectory->at(plan_.trajectory->endTime()).position;
  const Eigen::Vector3d flown_end = flown_.current->at(flown_.current->endTime()).position;
  if (!collision && (end - flown_end).norm() < kProgress) {
    ends_at_goal_ = plan_.end == PathEnd::kGoal;
    if (rests && !ends_at_goal_) {
      set(FlightState::kNoPath, "no way leads nearer to the goal");
      lookAround(input);
    }
    return;
  }
  // From rest it may begin at any time.
  const double begin = rests ? std::max(now, start_time) : start_time;
  accept(Trajectory(plan_.trajectory->curve(), begin), input);
}

void Flight::accept(Trajectory trajectory, const FlightInput& input) {
  if (flown_.rests(input.time) && mustTurnFirst(trajectory, input)) return;
  ++status_.plans;
  looked_around_ = 0.0;
  ends_at_goal_ = plan_.end == PathEnd::kGoal;
  flown_.next = std::make_shared<const Trajectory>(std::move(trajectory));
}

void Flight::hover(double heading, double time) {
  const Eigen::Vector3d position = flown_.current->at(time).position;
  flown_.current = std::make_shared<const Trajectory>(Trajectory::hover(position, time, heading));
}

void Flight::lookAround(const FlightInput& input) {
  const double heading = flown_.current->heading().value_or(input.vehicle.yaw);
  const double turn = 2.0 * config_.view_azimuth;
  const bool turns = angleBetween(heading, input.vehicle.yaw) > kTurned;
  if (turns || turn <= 0.0 || looked_around_ + turn >= 2.0 * M_PI) return;
  looked_around_ += turn;
  hover(heading + turn, input.time);
}

bool Flight::mustTurnFirst(const Trajectory& trajectory, const FlightInput& input) {
  const std::optional<double> heading = headingOf(trajectory);
  if (!heading || angleBetween(*heading, input.vehicle.yaw) <= config_.turn_first_angle) {
    return false;
  }
  hover(*heading, input.time);
  set(FlightState::kHovering, "turns to where it will fly");
  return true;
}

void Flight::brake(const std::string& reason) {
  const double now = clock_();
  flown_.advance(now);
  ends_at_goal_ = false;
  set(FlightState::kBraking, reason);
  auto braked =
      std::make_shared<const Trajectory>(flown_.current->braked(now, planner_config_.max_braking));
  const bool stops_in_time =
      !space_ || !firstCollision(*braked, *space_, {now}, planner_config_.max_escape);
  if (flown_.next && !stops_in_time) {
    // The next one was planned because of what is ahead on this one.
    flown_.next =
        std::make_shared<const Trajectory>(flown_.next->braked(now, planner_config_.max_braking));
  } else {
    flown_ = {std::move(braked), nullptr};
  }
}

std::optional<double> Flight::nextCollision(const FlightInput& input) const {
  if (!space_) return std::nullopt;
  const double max_escape = planner_config_.max_escape;
  if (!flown_.next) return firstCollision(*flown_.current, *space_, {input.time}, max_escape);
  const double switched = flown_.next->startTime();
  // A vehicle that rests where it must not be gets out of there with the next one.
  if (input.time >= flown_.current->endTime()) {
    return firstCollision(*flown_.next, *space_, {switched}, max_escape);
  }
  const std::optional<double> before =
      firstCollision(*flown_.current, *space_, {input.time, switched}, max_escape);
  return before ? before : firstCollision(*flown_.next, *space_, {switched}, max_escape);
}

double Flight::timeToBrake(double time) const {
  return flown_.at(time).at(time).velocity.norm() / planner_config_.max_braking;
}

bool Flight::fliesBlindly(const FlightInput& input) const {
  if (!space_) return false;
  const VehicleState& vehicle = input.vehicle;
  const double soon = timeToBrake(input.time) + config_.braking_margin + status_.planning_time;
  for (double time = input.time; time < input.time + soon; time += kBlindStep) {
    const Eigen::Vector3d place = flown_.at(time).at(time).position;
    const Eigen::Vector2d way = (place - vehicle.position).head<2>();
    if (way.norm() < kOwnPlace || !space_->isUnseen(place)) continue;
    if (angleBetween(std::atan2(way.y(), way.x()), vehicle.yaw) > config_.view_azimuth) return true;
  }
  return false;
}

void Flight::set(FlightState state, const std::string& reason) {
  status_.state = state;
  status_.reason = reason;
}

}  // namespace fiimap
