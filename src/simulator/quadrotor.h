#pragma once

#include <Eigen/Geometry>

namespace fiimap::sim {

/// Limits and gains; names are the parameter names.
struct QuadrotorConfig {
  double max_velocity = 8.0;
  double max_acceleration = 7.0;
  double max_jerk = 80.0;
  double max_yaw_rate = 3.0;
  double position_gain = 2.0;
  double velocity_gain = 5.0;
  double attitude_gain = 20.0;
  double yaw_gain = 4.0;
};

/// Where the vehicle shall be, in the world frame.
struct Setpoint {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_W = Eigen::Vector3d::Zero();
  double yaw = 0.0;  ///< rad
};

/// A multirotor as planners know it: thrust stands upright on the rotors, so acceleration tilts the
/// body, and turning the body takes time. A cascade of controllers asks for an acceleration; the
/// real one follows it with a delay and a limited jerk, which is how fast body and thrust turn.
/// It moves on a straight line towards what is asked, so it never leaves the ball of the largest
/// acceleration. Not thread-safe.
class Quadrotor {
 public:
  struct State {
    Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d acceleration_W = Eigen::Vector3d::Zero();
    double yaw = 0.0;       ///< rad, not wrapped
    double yaw_rate = 0.0;  ///< rad/s

    /// Body (x forward, y left, z along the thrust) to world.
    Eigen::Isometry3d T_W_B() const;
  };

  Quadrotor(const QuadrotorConfig& config, const Eigen::Vector3d& position_W, double yaw);

  const State& state() const { return state_; }

  /// Flies for a time towards a setpoint. \param step s, a few milliseconds.
  void advance(const Setpoint& setpoint, double step);

  /// Slows down as fast as the limits allow, keeping the yaw.
  void brake(double step);

 private:
  Eigen::Vector3d accelerationFor(const Setpoint& setpoint) const;
  void fly(const Eigen::Vector3d& wanted_acceleration_W, double wanted_yaw_rate, double step);

  QuadrotorConfig config_;
  State state_;
};

}  // namespace fiimap::sim
