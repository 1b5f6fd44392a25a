#include <cmath>

#include "random.h"
#include "worlds/world.h"

namespace fiimap::sim {
namespace {

constexpr double kHalfWidth = 2.0;             // m, between the walls
constexpr double kCorridorHeight = 3.0;        // m
constexpr double kCorridorMargin = 3.0;        // m behind the start and beyond the goal
constexpr double kThickness = 0.2;             // m, of walls, floor and ceiling
constexpr double kCorridorFlightHeight = 1.3;  // m
constexpr double kFirstObstacle = 4.0;         // m after the start; as far before the goal
constexpr int kColumnSides = 16;

/// The shell of a room between two corners, open nowhere.
void addShell(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Mesh* mesh) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d first = low, last = high;
    first[axis] = low[axis] - kThickness;
    last[axis] = low[axis];
    mesh->addBoxBetween(first, last);
    first[axis] = high[axis];
    last[axis] = high[axis] + kThickness;
    mesh->addBoxBetween(first, last);
  }
}

/// A wall across the corridor with a door.
void addDoor(double x, double gap, Random* random, Mesh* mesh) {
  const double middle = random->uniform(-kHalfWidth + gap, kHalfWidth - gap);
  const double left = middle + gap / 2.0, right = middle - gap / 2.0;
  const double top = random->uniform(2.0, 2.4);
  mesh->addBoxBetween({x, -kHalfWidth, 0.0}, {x + kThickness, right, kCorridorHeight});
  mesh->addBoxBetween({x, left, 0.0}, {x + kThickness, kHalfWidth, kCorridorHeight});
  mesh->addBoxBetween({x, right, top}, {x + kThickness, left, kCorridorHeight});
}

/// A cupboard at one of the walls.
void addCupboard(double x, double gap, Random* random, Mesh* mesh) {
  const double depth = random->uniform(0.8, 2.0 * kHalfWidth - gap);
  const double side = random->chance(0.5) ? 1.0 : -1.0;
  const double y = side * (kHalfWidth - depth / 2.0);
  const Eigen::Vector3d size(random->uniform(0.4, 1.0), depth, kCorridorHeight);
  mesh->addBox({x, y, kCorridorHeight / 2.0}, size);
}

/// A beam that is passed below, or a table that is passed above.
void addBeam(double x, Random* random, Mesh* mesh) {
  const double thickness = random->uniform(0.3, 1.0);
  const double z = random->chance(0.5) ? thickness / 2.0 : kCorridorHeight - thickness / 2.0;
  mesh->addBox({x, 0.0, z}, {random->uniform(0.2, 0.8), 2.0 * kHalfWidth, thickness});
}

void addColumn(double x, double gap, Random* random, Mesh* mesh) {
  const double radius = random->uniform(0.1, 0.3);
  const double reach = kHalfWidth - radius;
  // Where it leaves the gap on neither side, it stands at a wall.
  double y = random->uniform(-reach, reach);
  if (kHalfWidth + std::abs(y) - radius < gap) y = reach;
  mesh->addCylinder({x, y, 0.0}, {x, y, kCorridorHeight}, radius, radius, kColumnSides);
}

}  // namespace

World makeCorridor(const WorldConfig& config) {
  Random random(static_cast<std::uint64_t>(config.seed));
  World world;
  world.start_W = {0.0, 0.0, kCorridorFlightHeight};
  world.goal_W = {config.length, 0.0, kCorridorFlightHeight};
  addShell({-kCorridorMargin, -kHalfWidth, 0.0},
           {config.length + kCorridorMargin, kHalfWidth, kCorridorHeight}, &world.still);
  double x = kFirstObstacle;
  while (x < config.length - kFirstObstacle) {
    switch (random.uniformInt(0, 3)) {
      case 0:
        addDoor(x, config.least_gap, &random, &world.still);
        break;
      case 1:
        addCupboard(x, config.least_gap, &random, &world.still);
        break;
      case 2:
        addBeam(x, &random, &world.still);
        break;
      default:
        addColumn(x, config.least_gap, &random, &world.still);
    }
    x += random.uniform(3.0, 6.0);
  }
  return world;
}

}  // namespace fiimap::sim
