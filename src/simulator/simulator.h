#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "depth_camera.h"
#include "depth_noise.h"
#include "flight_record.h"
#include "lidar.h"
#include "odometry_error.h"
#include "quadrotor.h"
#include "ray_scene.h"
#include "simulator_config.h"

namespace fiimap::sim {

/// What state estimation says, in the odometry frame O that it believes to be the world.
struct OdometrySample {
  double time = 0.0;  ///< s, when it was true
  Eigen::Isometry3d T_O_B = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_B = Eigen::Vector3d::Zero();
  double yaw_rate = 0.0;  ///< rad/s
};

/// A vehicle with its sensors in a world, in fixed steps of time: the same configuration and the
/// same commands at the same steps give the same bytes. Knows no clock and no ROS. Not thread-safe.
class Simulator {
 public:
  static constexpr int kStepsPerSecond = 300;

  /// \throws std::exception when the configuration is not valid or the world cannot be made.
  explicit Simulator(const SimulatorConfig& config);

  /// Seconds since the start.
  double time() const { return static_cast<double>(steps_) / kStepsPerSecond; }
  std::uint64_t steps() const { return steps_; }

  /// A new setpoint of the vehicle, in the odometry frame: its flight controller knows no better.
  /// \param time s, when the vehicle shall be there; it goes on from there as the command began.
  void command(const Setpoint& setpoint_O, double time);

  /// One step of time.
  void advance();

  /// Odometry that arrives in this step.
  std::optional<OdometrySample> odometry();
  /// Whether an event of a rate, Hz, falls into this step.
  bool isDue(double rate) const;
  bool odometryIsDue() const { return isDue(config_.odometry.odometry_rate); }
  /// Whether a sensor is triggered in this step.
  bool cameraIsDue() const { return isDue(config_.camera.camera_rate); }
  bool lidarIsDue() const {
    return config_.lidar.lidar != LidarKind::kNone && isDue(config_.lidar.lidar_rate);
  }
  /// The sensors' readings of this moment. Errors of a frame depend on its number alone.
  std::vector<std::uint16_t> depthImage();
  std::vector<Eigen::Vector3f> lidarPoints();

  /// The truth.
  const Quadrotor::State& vehicle() const { return vehicle_.state(); }
  const FlightRecord& record() const { return record_; }
  const RayScene& scene() const { return scene_; }

 private:
  void fly();
  Setpoint extrapolatedCommand() const;
  double measureClearance() const;

  SimulatorConfig config_;
  RayScene scene_;
  Quadrotor vehicle_;
  OdometryError odometry_error_;
  DepthCamera camera_;
  DepthNoise noise_;
  Lidar lidar_;

  std::uint64_t steps_ = 0;
  std::optional<Setpoint> setpoint_O_;  // none: hovers at hover_W_
  double setpoint_time_ = 0.0;          // s, when it holds
  std::uint64_t setpoint_step_ = 0;     // when it came
  Setpoint hover_W_;
  FlightRecord record_;
  std::deque<OdometrySample> odometry_;  // on its way
};

}  // namespace fiimap::sim
