#include "odometry_error.h"

#include <cmath>

namespace fiimap::sim {
namespace {

constexpr std::uint64_t kStream = 2;  // of random numbers

Eigen::Vector3d normalVector(Random* random) {
  const double x = random->normal(), y = random->normal(), z = random->normal();
  return {x, y, z};
}

}  // namespace

OdometryError::OdometryError(const OdometryConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, kStream), next_jump_(config.odometry_jump_period) {}

void OdometryError::advance(double time, double step, const Eigen::Vector3d& position_W) {
  // The standard deviation of a random walk grows with the square root of time.
  const double root = std::sqrt(step);
  if (config_.odometry_drift > 0.0 || config_.odometry_yaw_drift > 0.0) {
    const Eigen::Vector3d shift_O = config_.odometry_drift * root * normalVector(&random_);
    move(shift_O, config_.odometry_yaw_drift * root * random_.normal(), position_W);
  }
  if (config_.odometry_jump > 0.0 && time >= next_jump_) {
    next_jump_ += config_.odometry_jump_period;
    const Eigen::Vector3d direction_O = normalVector(&random_).normalized();
    move(config_.odometry_jump * direction_O, 0.0, position_W);
  }
}

void OdometryError::move(const Eigen::Vector3d& shift_O, double turn,
                         const Eigen::Vector3d& position_W) {
  const Eigen::Vector3d position_O = T_O_W_ * position_W;
  const Eigen::AngleAxisd rotation(turn, Eigen::Vector3d::UnitZ());
  T_O_W_ = Eigen::Translation3d(position_O + shift_O) * rotation *
           Eigen::Translation3d(-position_O) * T_O_W_;
}

}  // namespace fiimap::sim
