#pragma once

#include <string>
#include <vector>

#include "mesh.h"

namespace fiimap::sim {

enum class WorldKind { kForest, kCorridor, kShelfRoom, kMaze, kMesh };

/// What world to make; names are the parameter names. Units, ranges and meanings:
/// simulator_config.cpp and config/simulator.yaml.
struct WorldConfig {
  WorldKind world = WorldKind::kForest;
  int seed = 1;
  double length = 110.0;
  double width = 24.0;
  double tree_density = 0.07;
  double least_gap = 1.2;
  int maze_cells = 6;
  std::string mesh_file;
  double mesh_scale = 1.0;
  double start_x = 0.0;
  double start_y = 0.0;
  double start_z = 1.5;
  double start_yaw = 0.0;
  int moving_obstacles = 0;
  double moving_speed = 0.5;
};

/// Swings on a line.
struct MovingObstacle {
  Mesh shape;                  ///< around its position
  Eigen::AlignedBox3d bounds;  ///< of the shape
  Eigen::Vector3d middle_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d reach_W = Eigen::Vector3d::Zero();  ///< from the middle to where it turns
  double angular_frequency = 0.0;                     ///< rad/s
  double phase = 0.0;                                 ///< rad

  Eigen::Vector3d positionAt(double time) const;
};

/// Geometry in the world frame, z up, and where a flight may begin and end.
struct World {
  Mesh still;
  std::vector<MovingObstacle> moving;
  Eigen::Vector3d start_W = Eigen::Vector3d::Zero();
  double start_yaw = 0.0;  ///< rad
  Eigen::Vector3d goal_W = Eigen::Vector3d::Zero();
};

/// The same world for the same configuration.
/// \throws std::invalid_argument when a mesh file cannot be read.
World makeWorld(const WorldConfig& config);

// The kinds of worlds, without moving obstacles.
World makeForest(const WorldConfig& config);
World makeCorridor(const WorldConfig& config);
World makeShelfRoom(const WorldConfig& config);
World makeMaze(const WorldConfig& config);
World makeMeshWorld(const WorldConfig& config);

/// Pillars that swing across the way from start to goal, at least a few metres from both. They may
/// swing through what stands still.
std::vector<MovingObstacle> makeMovingObstacles(const WorldConfig& config, const World& world);

}  // namespace fiimap::sim
