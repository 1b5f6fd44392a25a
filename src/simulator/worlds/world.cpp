#include "worlds/world.h"

#include <cmath>

namespace fiimap::sim {

Eigen::Vector3d MovingObstacle::positionAt(double time) const {
  return middle_W + std::sin(angular_frequency * time + phase) * reach_W;
}

World makeWorld(const WorldConfig& config) {
  World world;
  switch (config.world) {
    case WorldKind::kForest:
      world = makeForest(config);
      break;
    case WorldKind::kCorridor:
      world = makeCorridor(config);
      break;
    case WorldKind::kShelfRoom:
      world = makeShelfRoom(config);
      break;
    case WorldKind::kMaze:
      world = makeMaze(config);
      break;
    case WorldKind::kMesh:
      world = makeMeshWorld(config);
      break;
  }
  world.moving = makeMovingObstacles(config, world);
  return world;
}

}  // namespace fiimap::sim
