#include "quadrotor.h"

#include <algorithm>
#include <cmath>

namespace fiimap::sim {
namespace {

const Eigen::Vector3d kGravity_W(0.0, 0.0, -9.81);  // m/s^2

Eigen::Vector3d limited(const Eigen::Vector3d& vector, double longest) {
  const double length = vector.norm();
  return length > longest ? Eigen::Vector3d(vector * (longest / length)) : vector;
}

}  // namespace

Eigen::Isometry3d Quadrotor::State::T_W_B() const {
  const Eigen::Vector3d up = (acceleration_W - kGravity_W).normalized();
  const Eigen::Vector3d heading(std::cos(yaw), std::sin(yaw), 0.0);
  // Seen from above the nose points along the yaw, however the body tilts.
  const Eigen::Vector3d forward =
      (up.z() * heading - heading.dot(up) * Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  T_W_B.linear() << forward, up.cross(forward), up;
  T_W_B.translation() = position_W;
  return T_W_B;
}

Quadrotor::Quadrotor(const QuadrotorConfig& config, const Eigen::Vector3d& position_W, double yaw)
    : config_(config) {
  state_.position_W = position_W;
  state_.yaw = yaw;
}

void Quadrotor::advance(const Setpoint& setpoint, double step) {
  const double turn = std::remainder(setpoint.yaw - state_.yaw, 2.0 * M_PI);
  fly(accelerationFor(setpoint), config_.yaw_gain * turn, step);
}

void Quadrotor::brake(double step) { fly(-config_.velocity_gain * state_.velocity_W, 0.0, step); }

Eigen::Vector3d Quadrotor::accelerationFor(const Setpoint& setpoint) const {
  const Eigen::Vector3d velocity_W =
      setpoint.velocity_W + config_.position_gain * (setpoint.position_W - state_.position_W);
  return setpoint.acceleration_W +
         config_.velocity_gain * (limited(velocity_W, config_.max_velocity) - state_.velocity_W);
}

void Quadrotor::fly(const Eigen::Vector3d& wanted_acceleration_W, double wanted_yaw_rate,
                    double step) {
  const Eigen::Vector3d wanted_W = limited(wanted_acceleration_W, config_.max_acceleration);
  // No more than what reaches the wanted acceleration within this step.
  const double gain = std::min(config_.attitude_gain, 1.0 / step);
  const Eigen::Vector3d jerk_W =
      limited(gain * (wanted_W - state_.acceleration_W), config_.max_jerk);
  state_.position_W +=
      step * (state_.velocity_W + step * (state_.acceleration_W / 2.0 + step * jerk_W / 6.0));
  state_.velocity_W += step * (state_.acceleration_W + step * jerk_W / 2.0);
  state_.acceleration_W += step * jerk_W;
  state_.yaw_rate = std::clamp(wanted_yaw_rate, -config_.max_yaw_rate, config_.max_yaw_rate);
  state_.yaw += step * state_.yaw_rate;
}

}  // namespace fiimap::sim
