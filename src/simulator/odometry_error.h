#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "random.h"

namespace fiimap::sim {

/// What state estimation gets wrong; names are the parameter names.
struct OdometryConfig {
  double odometry_rate = 100.0;
  double odometry_drift = 0.0;
  double odometry_yaw_drift = 0.0;
  double odometry_delay = 0.0;
  double odometry_jump = 0.0;
  double odometry_jump_period = 10.0;
};

/// The estimated world moves against the true one: the position by a random walk and by jumps, the
/// yaw by a random walk around the place of the vehicle.
class OdometryError {
 public:
  OdometryError(const OdometryConfig& config, std::uint64_t seed);

  /// \param time s, since the start; \param step s; \param position_W true position.
  void advance(double time, double step, const Eigen::Vector3d& position_W);

  /// True world to estimated world ("odometry frame").
  const Eigen::Isometry3d& T_O_W() const { return T_O_W_; }

 private:
  void move(const Eigen::Vector3d& shift_O, double turn, const Eigen::Vector3d& position_W);

  OdometryConfig config_;
  Random random_;
  double next_jump_;
  Eigen::Isometry3d T_O_W_ = Eigen::Isometry3d::Identity();
};

}  // namespace fiimap::sim
