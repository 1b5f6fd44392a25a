#include "worlds/world.h"

#include <gtest/gtest.h>

#include <queue>
#include <set>
#include <tuple>

#include "geometry_oracle.h"
#include "ray_scene.h"

namespace fiimap::sim {
namespace {

constexpr double kClearance = 0.35;  // m, of a small vehicle with some room
constexpr double kStep = 0.25;       // m

WorldConfig configOf(WorldKind kind, int seed) {
  WorldConfig config;
  config.world = kind;
  config.seed = seed;
  config.length = 30.0;
  config.maze_cells = 5;
  return config;
}

/// Whether steps of a grid lead from start to goal with clearance, inside of the world's bounds.
bool goalIsReachable(const World& world) {
  const RayScene scene(world);
  const Eigen::AlignedBox3d bounds = world.still.bounds().cast<double>();
  using Cell = std::tuple<int, int, int>;
  const auto position = [&](const Cell& cell) -> Eigen::Vector3d {
    const auto& [x, y, z] = cell;
    return world.start_W + kStep * Eigen::Vector3d(x, y, z);
  };
  std::queue<Cell> open({Cell(0, 0, 0)});
  std::set<Cell> seen = {Cell(0, 0, 0)};
  while (!open.empty()) {
    const Cell cell = open.front();
    open.pop();
    if ((position(cell) - world.goal_W).norm() < 2 * kStep) return true;
    const auto& [x, y, z] = cell;
    for (const Cell& next : {Cell(x + 1, y, z), Cell(x - 1, y, z), Cell(x, y + 1, z),
                             Cell(x, y - 1, z), Cell(x, y, z + 1), Cell(x, y, z - 1)}) {
      const Eigen::Vector3d point_W = position(next);
      if (!bounds.contains(point_W) || point_W.z() > 3.0 || seen.count(next)) continue;
      seen.insert(next);
      if (scene.distance(point_W, 0.0, 1.0) >= kClearance) open.push(next);
    }
  }
  return false;
}

TEST(WorldsTest, EveryWorldLeadsFromStartToGoal) {
  for (const WorldKind kind :
       {WorldKind::kForest, WorldKind::kCorridor, WorldKind::kShelfRoom, WorldKind::kMaze}) {
    for (int seed = 0; seed < 5; ++seed) {
      const World world = makeWorld(configOf(kind, seed));
      const RayScene scene(world);
      EXPECT_GT(scene.distance(world.start_W, 0.0, 10.0), 0.8);
      EXPECT_GT(scene.distance(world.goal_W, 0.0, 10.0), 0.8);
      EXPECT_TRUE(goalIsReachable(world))
          << "world " << static_cast<int>(kind) << ", seed " << seed;
    }
  }
}

TEST(WorldsTest, ASeedIsOneWorld) {
  for (const WorldKind kind :
       {WorldKind::kForest, WorldKind::kCorridor, WorldKind::kShelfRoom, WorldKind::kMaze}) {
    const World world = makeWorld(configOf(kind, 3)), again = makeWorld(configOf(kind, 3));
    const World other = makeWorld(configOf(kind, 4));
    EXPECT_EQ(world.still.vertices, again.still.vertices);
    EXPECT_EQ(world.still.triangles, again.still.triangles);
    EXPECT_NE(world.still.vertices, other.still.vertices);
  }
}

TEST(WorldsTest, TheForestIsLongAndInTheWay) {
  WorldConfig config;
  const World world = makeWorld(config);
  EXPECT_GE((world.goal_W - world.start_W).norm(), 100.0);
  // A vehicle that flies straight ahead hits something, more than once.
  const RayScene scene(world);
  int contacts = 0;
  bool was_clear = true;
  for (double x = 0.0; x < config.length; x += 0.05) {
    const bool clear =
        scene.distance(world.start_W + Eigen::Vector3d(x, 0, 0), 0.0, 1.0) > kClearance;
    contacts += was_clear && !clear;
    was_clear = clear;
  }
  EXPECT_GT(contacts, 2);
}

TEST(WorldsTest, MovingObstaclesSwingAtTheirSpeedAwayFromStartAndGoal) {
  WorldConfig config = configOf(WorldKind::kCorridor, 1);
  config.moving_obstacles = 20;
  config.moving_speed = 0.7;
  const World world = makeWorld(config);
  ASSERT_EQ(world.moving.size(), 20u);
  constexpr double kTick = 0.01;  // s
  double fastest = 0.0;
  for (const MovingObstacle& obstacle : world.moving) {
    for (double time = 0.0; time < 30.0; time += kTick) {
      const Eigen::Vector3d here_W = obstacle.positionAt(time);
      fastest = std::max(fastest, (obstacle.positionAt(time + kTick) - here_W).norm() / kTick);
      EXPECT_GT((here_W - world.start_W).head<2>().norm(), 3.0);
      EXPECT_GT((here_W - world.goal_W).head<2>().norm(), 3.0);
    }
  }
  EXPECT_NEAR(fastest, 0.7, 0.001);
}

}  // namespace
}  // namespace fiimap::sim
