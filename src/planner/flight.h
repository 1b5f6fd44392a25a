#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flown_trajectory.h"
#include "planner_config.h"
#include "trajectory_planner.h"

namespace fiimap {

enum class FlightState { kWaiting, kHovering, kFlying, kBraking, kNoPath, kGoalReached };

/// Where the vehicle is by its odometry, in the map frame.
struct VehicleState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double yaw = 0.0;                                    ///< rad
};

/// What a flight knows at one moment.
struct FlightInput {
  double time = 0.0;  ///< s
  /// Null: nothing is known, as between a reset of the map and the next scan. A trajectory that was
  /// checked before is flown on then, but no new one is planned.
  std::shared_ptr<const Snapshot> snapshot;
  VehicleState vehicle;
  std::string map_trouble;       ///< why the map cannot be trusted any more; empty: it can
  std::string odometry_trouble;  ///< likewise for the vehicle's state
};

struct FlightStatus {
  FlightState state = FlightState::kWaiting;
  std::string reason;          ///< for the state, to be read by people
  double goal_distance = 0.0;  ///< m, of the vehicle; 0 without a goal
  std::uint64_t plans = 0;     ///< trajectories that were accepted
  std::uint64_t failures = 0;  ///< attempts to plan that gave none, or too late
  double planning_time = 0.0;  ///< s, the newest attempt
};

/// Decides what to fly: plans to the goals, checks what is flown against every snapshot, plans
/// again ahead of time, and brakes when nothing is left. Not thread-safe.
class Flight {
 public:
  using Clock = std::function<double()>;

  /// \param clock the time, s: planning takes some.
  Flight(const PlannerConfig& planner, const FlightConfig& config, Clock clock);

  /// Flies to these points one after the other; the last one is a place to rest. Metres, finite.
  void setGoals(const std::vector<Eigen::Vector3d>& goals);
  const std::deque<Eigen::Vector3d>& goals() const { return goals_; }

  /// To be called with every snapshot, and often between them.
  void step(const FlightInput& input);
  /// Forgets what is flown: time jumped. The goals stay.
  void restart();

  const FlownTrajectory& flown() const { return flown_; }
  const FlightStatus& status() const { return status_; }
  /// The newest attempt to plan.
  const Plan& plan() const { return plan_; }

 private:
  void followVehicle(const FlightInput& input);
  void passGoals(const FlightInput& input);
  void flyTo(const Eigen::Vector3d& goal, const FlightInput& input);
  bool wantsPlan(double time, bool collides) const;
  void planTo(const Eigen::Vector3d& goal, const FlightInput& input,
              std::optional<double> collision);
  double planStart(double time) const;
  void accept(Trajectory trajectory, const FlightInput& input);
  /// Stays where it is and looks to a heading, rad.
  void hover(double heading, double time);
  /// Without a way: turns on by what the sensor sees, until it looked all around, once at a place.
  /// Perhaps there is a way where it did not look, or an obstacle of the map is none.
  void lookAround(const FlightInput& input);
  bool mustTurnFirst(const Trajectory& trajectory, const FlightInput& input);
  void brake(const std::string& reason);
  bool hasJustBraked(double time) const;
  std::optional<double> nextCollision(const FlightInput& input) const;
  double timeToBrake(double time) const;
  /// Whether it will soon be too late to brake before a place that it neither saw nor looks at.
  bool fliesBlindly(const FlightInput& input) const;
  void set(FlightState state, const std::string& reason);

  PlannerConfig planner_config_;
  FlightConfig config_;
  Clock clock_;
  TrajectoryPlanner planner_;

  std::deque<Eigen::Vector3d> goals_;
  bool goal_is_new_ = false;
  bool ends_at_goal_ = false;   ///< what is flown
  double last_attempt_ = 0.0;   ///< to plan, s
  double looked_around_ = 0.0;  ///< rad that it turned at this place to find a way
  FlownTrajectory flown_;
  std::optional<FlightSpace> space_;
  Plan plan_;
  FlightStatus status_;
};

}  // namespace fiimap
