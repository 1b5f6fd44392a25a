#include <cmath>

#include "random.h"
#include "worlds/world.h"

namespace fiimap::sim {
namespace {

// A hall of 16 x 12 x 4 m, x and y from its middle.
constexpr double kHalfLength = 8.0;
constexpr double kRoomHalfWidth = 6.0;
constexpr double kRoomHeight = 4.0;
constexpr double kRoomWall = 0.2;
constexpr int kSides = 20;

void addHall(Mesh* mesh) {
  const double x = kHalfLength, y = kRoomHalfWidth;
  mesh->addBoxBetween({-x - kRoomWall, -y - kRoomWall, -kRoomWall},
                      {x + kRoomWall, y + kRoomWall, 0.0});
  mesh->addBoxBetween({-x - kRoomWall, -y - kRoomWall, 0.0}, {-x, y + kRoomWall, kRoomHeight});
  mesh->addBoxBetween({x, -y - kRoomWall, 0.0}, {x + kRoomWall, y + kRoomWall, kRoomHeight});
  mesh->addBoxBetween({-x, -y - kRoomWall, 0.0}, {x, -y, kRoomHeight});
  mesh->addBoxBetween({-x, y, 0.0}, {x, y + kRoomWall, kRoomHeight});
}

/// Four boards on uprights, half full of boxes.
void addShelf(const Eigen::Vector2d& corner, double length, Random* random, Mesh* mesh) {
  constexpr double kDepth = 0.6, kBoard = 0.04, kUpright = 0.06, kLevel = 0.7;
  constexpr int kLevels = 4;
  const double x = corner.x(), y = corner.y();
  for (int level = 0; level < kLevels; ++level) {
    const double z = 0.1 + level * kLevel;
    mesh->addBoxBetween({x, y, z}, {x + length, y + kDepth, z + kBoard});
    for (double at = x + 0.1; at < x + length - 0.5; at += 0.55) {
      if (!random->chance(0.5)) continue;
      const double width = random->uniform(0.2, 0.45), height = random->uniform(0.15, 0.5);
      mesh->addBoxBetween({at, y + 0.1, z + kBoard},
                          {at + width, y + random->uniform(0.3, 0.55), z + kBoard + height});
    }
  }
  for (const double at : {x, x + length / 2.0, x + length - kUpright}) {
    for (const double side : {y, y + kDepth - kUpright}) {
      mesh->addBoxBetween({at, side, 0.0},
                          {at + kUpright, side + kUpright, 0.1 + kLevels * kLevel});
    }
  }
}

}  // namespace

World makeShelfRoom(const WorldConfig& config) {
  Random random(static_cast<std::uint64_t>(config.seed));
  World world;
  Mesh& mesh = world.still;
  world.start_W = {-6.5, -4.5, 1.2};
  world.start_yaw = 0.6;
  world.goal_W = {6.5, 4.5, 1.2};
  addHall(&mesh);
  addShelf({-4.0, 1.0}, 6.0, &random, &mesh);

  const auto near = [&random](double x, double y) {
    constexpr double kShift = 0.5;
    const double shift_x = random.uniform(-kShift, kShift);
    const double shift_y = random.uniform(-kShift, kShift);
    return Eigen::Vector2d(x + shift_x, y + shift_y);
  };
  const Eigen::Vector2d box = near(-2.5, -2.0), column = near(1.0, -3.0), cone = near(4.5, -1.5);
  const Eigen::Vector2d ball = near(4.0, 2.5), block = near(-6.0, 3.5), beam = near(2.0, -0.8);
  mesh.addBox({box.x(), box.y(), 0.9}, {1.0, 1.4, 1.8}, random.uniform(-M_PI, M_PI));
  mesh.addBox({block.x(), block.y(), 0.4}, {1.2, 0.8, 0.8}, random.uniform(-M_PI, M_PI));
  mesh.addCylinder({column.x(), column.y(), 0.0}, {column.x(), column.y(), 3.0}, 0.35, 0.35,
                   kSides);
  mesh.addCylinder({cone.x(), cone.y(), 0.0}, {cone.x(), cone.y(), 2.2}, 0.9, 0.05, kSides);
  mesh.addEllipsoid({ball.x(), ball.y(), 1.4}, {0.7, 0.7, 0.7});
  mesh.addBox({beam.x(), beam.y(), 2.4}, {3.0, 0.3, 0.3}, random.uniform(-M_PI, M_PI));
  return world;
}

}  // namespace fiimap::sim
