#pragma once

#include <string>
#include <vector>

#include "depth_camera.h"
#include "depth_noise.h"
#include "fiimap/parameters.h"
#include "lidar.h"
#include "odometry_error.h"
#include "quadrotor.h"
#include "worlds/world.h"

namespace fiimap::sim {

/// Settings of the simulator. Names are the parameter names; units, ranges and meanings:
/// simulator_config.cpp and config/simulator.yaml.
struct SimulatorConfig {
  WorldConfig world;
  CameraConfig camera;
  NoiseConfig noise;
  LidarConfig lidar;
  OdometryConfig odometry;
  QuadrotorConfig vehicle;
  double vehicle_radius = 0.2;
  double command_timeout = 0.5;

  bool publish_clock = false;
  double real_time_factor = 1.0;
  double max_lead = 0.0;

  std::string world_frame = "world";
  std::string body_frame = "base_link";
  std::string camera_frame = "camera_depth_optical_frame";
  std::string lidar_frame = "lidar";

  /// \throws std::invalid_argument that names the parameter, its value and what is allowed.
  void validate() const;
};

/// All parameters, bound to `config`, in the order of config/simulator.yaml.
std::vector<Parameter> simulatorParameters(SimulatorConfig* config);

}  // namespace fiimap::sim
