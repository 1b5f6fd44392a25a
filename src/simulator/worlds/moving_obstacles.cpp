#include <cmath>

#include "random.h"
#include "worlds/world.h"

namespace fiimap::sim {
namespace {

constexpr std::uint64_t kObstacleStream = 1;  // of random numbers: the still world has the other
constexpr double kClearDistance = 4.0;        // m along the way after the start and before the goal
constexpr double kObstacleHeight = 2.4;       // m
constexpr int kObstacleSides = 12;

}  // namespace

std::vector<MovingObstacle> makeMovingObstacles(const WorldConfig& config, const World& world) {
  Random random(static_cast<std::uint64_t>(config.seed), kObstacleStream);
  const Eigen::Vector2d way = (world.goal_W - world.start_W).head<2>();
  const double room = way.norm() - 2.0 * kClearDistance;
  std::vector<MovingObstacle> obstacles;
  if (room <= 0.0) return obstacles;
  const Eigen::Vector2d along = way.normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  for (int i = 0; i < config.moving_obstacles; ++i) {
    const double at = kClearDistance + random.uniform(0.0, room);
    const double reach = random.uniform(1.0, 3.0);
    const double radius = random.uniform(0.2, 0.4);
    MovingObstacle obstacle;
    obstacle.shape.addCylinder(Eigen::Vector3d::Zero(), {0.0, 0.0, kObstacleHeight}, radius, radius,
                               kObstacleSides);
    obstacle.bounds = obstacle.shape.bounds().cast<double>();
    obstacle.middle_W.head<2>() = world.start_W.head<2>() + at * along;
    obstacle.reach_W.head<2>() = reach * across;
    obstacle.angular_frequency = config.moving_speed / reach;  // fastest in the middle
    obstacle.phase = random.uniform(-M_PI, M_PI);
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

}  // namespace fiimap::sim
