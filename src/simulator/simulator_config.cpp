#include "simulator_config.h"

#include <limits>
#include <stdexcept>

namespace fiimap::sim {
namespace {

constexpr double kFar = 1e5;              // m
constexpr double kMaxAcceleration = 9.5;  // m/s^2; with less than gravity, thrust points upwards
constexpr double kMaxRate = 300.0;        // Hz: once a step
constexpr double kMinRate = 0.1;          // Hz
constexpr double kMaxDepth = 65.5;        // m, of 16 bits of millimetres
constexpr double kMaxDuration = 3600.0;   // s
constexpr double kPi = 3.14159;           // rad
constexpr double kHalfPi = 1.5707;        // rad
constexpr int kMaxSeed = std::numeric_limits<int>::max();
constexpr int kMaxPixels = 4096;

using Parameters = std::vector<Parameter>;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void append(Parameters more, Parameters* all) {
  for (Parameter& parameter : more) all->push_back(std::move(parameter));
}

Parameters worldParameters(WorldConfig* c) {
  return {
      choiceParameter("world", &c->world, {"forest", "corridor", "shelf_room", "maze", "mesh"},
                      "what to fly in"),
      integerParameter("seed", &c->seed, 0, kMaxSeed, "", "of world, noise and odometry errors"),
      numberParameter("length", &c->length, 10.0, 10000.0, "m",
                      "from start to goal, of forest and corridor"),
      numberParameter("width", &c->width, 4.0, 1000.0, "m", "of the forest"),
      numberParameter("tree_density", &c->tree_density, 0.0, 1.0, "trees per m^2",
                      "of the forest, as far as least_gap leaves room"),
      numberParameter("least_gap", &c->least_gap, 0.5, 2.0, "m",
                      "between trunks and bushes of the forest; to pass in the corridor"),
      integerParameter("maze_cells", &c->maze_cells, 2, 50, "cells", "along each side of the maze"),
      textParameter("mesh_file", &c->mesh_file, "STL, OBJ, PLY, ... of the world mesh"),
      numberParameter("mesh_scale", &c->mesh_scale, 1e-6, 1e6, "m per unit", "of the mesh file"),
      numberParameter("start_x", &c->start_x, -kFar, kFar, "m", "where the vehicle starts, mesh"),
      numberParameter("start_y", &c->start_y, -kFar, kFar, "m", "where the vehicle starts, mesh"),
      numberParameter("start_z", &c->start_z, -kFar, kFar, "m", "where the vehicle starts, mesh"),
      numberParameter("start_yaw", &c->start_yaw, -kPi, kPi, "rad", "at the start, mesh"),
      integerParameter("moving_obstacles", &c->moving_obstacles, 0, 1000, "obstacles",
                       "pillars that swing across the way from start to goal"),
      numberParameter("moving_speed", &c->moving_speed, 0.0, 20.0, "m/s",
                      "largest of the moving obstacles"),
  };
}

Parameters cameraParameters(CameraConfig* c) {
  return {
      integerParameter("image_width", &c->image_width, 1, kMaxPixels, "pixels",
                       "of the depth image"),
      integerParameter("image_height", &c->image_height, 1, kMaxPixels, "pixels",
                       "of the depth image"),
      numberParameter("horizontal_fov", &c->horizontal_fov, 0.1, 2.8, "rad", "of the depth camera"),
      numberParameter("camera_rate", &c->camera_rate, 0.0, kMaxRate, "Hz", "0: no camera"),
      numberParameter("camera_x", &c->camera_x, -kFar, kFar, "m", "of the camera on the body"),
      numberParameter("camera_y", &c->camera_y, -kFar, kFar, "m", "of the camera on the body"),
      numberParameter("camera_z", &c->camera_z, -kFar, kFar, "m", "of the camera on the body"),
      numberParameter("camera_pitch", &c->camera_pitch, -kHalfPi, kHalfPi, "rad",
                      "of the camera on the body, positive looks down"),
      numberParameter("min_range", &c->min_range, 0.0, kMaxDepth, "m",
                      "nearer depth is missing: 0"),
      numberParameter("max_range", &c->max_range, 0.01, kMaxDepth, "m",
                      "farther depth is missing: 0"),
  };
}

Parameters noiseParameters(NoiseConfig* c) {
  return {
      flagParameter("depth_noise", &c->depth_noise, "whether depth images have errors"),
      numberParameter("baseline", &c->baseline, 0.001, 10.0, "m", "between the stereo cameras"),
      numberParameter("disparity_step", &c->disparity_step, 1e-6, 10.0, "pixels",
                      "disparity is rounded to multiples of it"),
      numberParameter("disparity_noise", &c->disparity_noise, 0.0, 10.0, "pixels",
                      "standard deviation of the disparity"),
      numberParameter("dropout", &c->dropout, 0.0, 1.0, "", "share of pixels missing anywhere"),
      numberParameter("max_incidence", &c->max_incidence, 0.0, kHalfPi, "rad",
                      "surfaces seen at a flatter angle to their normal are missing"),
  };
}

Parameters lidarParameters(LidarConfig* c) {
  return {
      choiceParameter("lidar", &c->lidar, {"none", "spinning", "livox"},
                      "rings, or a pattern that never repeats"),
      numberParameter("lidar_rate", &c->lidar_rate, kMinRate, kMaxRate, "Hz", "scans"),
      integerParameter("lidar_rings", &c->lidar_rings, 1, 256, "rings", "rays one above the other"),
      integerParameter("lidar_columns", &c->lidar_columns, 1, 10000, "columns",
                       "rays around; livox: rings x columns rays anywhere"),
      numberParameter("lidar_fov_down", &c->lidar_fov_down, -kHalfPi, kHalfPi, "rad",
                      "lowest ray below the horizontal plane"),
      numberParameter("lidar_fov_up", &c->lidar_fov_up, -kHalfPi, kHalfPi, "rad",
                      "highest ray above the horizontal plane"),
      numberParameter("lidar_range", &c->lidar_range, 0.1, 1000.0, "m",
                      "farther rays meet nothing"),
      numberParameter("lidar_noise", &c->lidar_noise, 0.0, 10.0, "m",
                      "standard deviation of the range"),
      numberParameter("lidar_x", &c->lidar_x, -kFar, kFar, "m", "of the LiDAR on the body"),
      numberParameter("lidar_y", &c->lidar_y, -kFar, kFar, "m", "of the LiDAR on the body"),
      numberParameter("lidar_z", &c->lidar_z, -kFar, kFar, "m", "of the LiDAR on the body"),
  };
}

Parameters odometryParameters(OdometryConfig* c) {
  return {
      numberParameter("odometry_rate", &c->odometry_rate, kMinRate, kMaxRate, "Hz",
                      "odometry, TF, ~truth and /clock"),
      numberParameter("odometry_drift", &c->odometry_drift, 0.0, 10.0, "m per sqrt(s)",
                      "random walk of the position"),
      numberParameter("odometry_yaw_drift", &c->odometry_yaw_drift, 0.0, 1.0, "rad per sqrt(s)",
                      "random walk of the yaw"),
      numberParameter("odometry_delay", &c->odometry_delay, 0.0, 10.0, "s",
                      "odometry and TF arrive so much later, with true stamps"),
      numberParameter("odometry_jump", &c->odometry_jump, 0.0, 100.0, "m",
                      "length of sudden jumps of the position"),
      numberParameter("odometry_jump_period", &c->odometry_jump_period, 0.1, kMaxDuration, "s",
                      "between jumps"),
  };
}

Parameters vehicleParameters(SimulatorConfig* config) {
  QuadrotorConfig* c = &config->vehicle;
  return {
      numberParameter("vehicle_radius", &config->vehicle_radius, 0.01, 10.0, "m",
                      "nearer surfaces are collisions"),
      numberParameter("max_velocity", &c->max_velocity, 0.1, 100.0, "m/s", "that is asked for"),
      numberParameter("max_acceleration", &c->max_acceleration, 0.1, kMaxAcceleration, "m/s^2",
                      "of the vehicle"),
      numberParameter("max_jerk", &c->max_jerk, 1.0, 10000.0, "m/s^3",
                      "how fast thrust turns and grows"),
      numberParameter("max_yaw_rate", &c->max_yaw_rate, 0.1, 100.0, "rad/s", "of the vehicle"),
      numberParameter("position_gain", &c->position_gain, 0.0, 100.0, "1/s",
                      "velocity asked for per position error"),
      numberParameter("velocity_gain", &c->velocity_gain, 0.1, 100.0, "1/s",
                      "acceleration asked for per velocity error"),
      numberParameter("attitude_gain", &c->attitude_gain, 0.1, 300.0, "1/s",
                      "how fast the acceleration follows what is asked for"),
      numberParameter("yaw_gain", &c->yaw_gain, 0.1, 100.0, "1/s", "yaw rate per yaw error"),
      numberParameter("command_timeout", &config->command_timeout, 0.01, kMaxDuration, "s",
                      "after a command without another the vehicle brakes and hovers"),
  };
}

Parameters runParameters(SimulatorConfig* c) {
  return {
      flagParameter("publish_clock", &c->publish_clock,
                    "time is simulated and published as /clock; needs use_sim_time"),
      numberParameter("real_time_factor", &c->real_time_factor, 0.0, 1000.0, "",
                      "simulated seconds per second; 0: as fast as possible"),
      numberParameter("max_lead", &c->max_lead, 0.0, kMaxDuration, "s",
                      "simulated time waits for commands and maps that are older; 0: it does not"),
      textParameter("world_frame", &c->world_frame, "frame of odometry and world"),
      textParameter("body_frame", &c->body_frame, "of the vehicle: x forward, y left, z up"),
      textParameter("camera_frame", &c->camera_frame, "optical: z forward, x right, y down"),
      textParameter("lidar_frame", &c->lidar_frame, "axes as the body's"),
  };
}

}  // namespace

std::vector<Parameter> simulatorParameters(SimulatorConfig* config) {
  Parameters all = worldParameters(&config->world);
  append(cameraParameters(&config->camera), &all);
  append(noiseParameters(&config->noise), &all);
  append(lidarParameters(&config->lidar), &all);
  append(odometryParameters(&config->odometry), &all);
  append(vehicleParameters(config), &all);
  append(runParameters(config), &all);
  return all;
}

void SimulatorConfig::validate() const {
  SimulatorConfig copy = *this;
  for (const Parameter& parameter : simulatorParameters(&copy)) parameter.set(parameter.get());

  const bool is_mesh = world.world == WorldKind::kMesh;
  if (is_mesh && world.mesh_file.empty()) {
    refuse("parameter mesh_file = '': must name a file, because world = mesh");
  }
  if (camera.max_range <= camera.min_range) {
    refuse("parameter max_range = " + std::to_string(camera.max_range) +
           ": must be larger than min_range");
  }
  if (lidar.lidar_fov_up < -lidar.lidar_fov_down) {
    refuse("parameter lidar_fov_up = " + std::to_string(lidar.lidar_fov_up) +
           ": must not be lower than lidar_fov_down below the horizontal plane");
  }
  constexpr double kSlowest = 0.001;
  if (real_time_factor > 0.0 && real_time_factor < kSlowest) {
    refuse("parameter real_time_factor = " + std::to_string(real_time_factor) +
           ": must be 0 or at least 0.001");
  }
  const bool in_wall_time = !publish_clock;
  if (in_wall_time && real_time_factor != 1.0) {
    refuse("parameter real_time_factor = " + std::to_string(real_time_factor) +
           ": must be 1, because publish_clock = false");
  }
  if (in_wall_time && max_lead > 0.0) {
    refuse("parameter max_lead = " + std::to_string(max_lead) +
           ": must be 0, because publish_clock = false");
  }
}

}  // namespace fiimap::sim
