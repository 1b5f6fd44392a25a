#include "lidar.h"

#include <gtest/gtest.h>

#include "geometry_oracle.h"

namespace fiimap::sim {
namespace {

World room() {
  World world;
  world.still.addBoxBetween({-3, -4, -1}, {5, 6, 3});
  return world;
}

/// Distance to the nearest of the room's planes, m.
double toRoom(const Eigen::Vector3d& point_W) {
  return std::min((point_W - Eigen::Vector3d(-3, -4, -1)).cwiseAbs().minCoeff(),
                  (Eigen::Vector3d(5, 6, 3) - point_W).cwiseAbs().minCoeff());
}

Eigen::Isometry3d somePose() {
  Eigen::Isometry3d T_W_L = Eigen::Isometry3d::Identity();
  T_W_L.translation() = Eigen::Vector3d(0.5, 1.0, 0.7);
  T_W_L.linear() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()))
                       .toRotationMatrix();
  return T_W_L;
}

TEST(LidarTest, RingsMeetTheWalls) {
  LidarConfig config;
  config.lidar = LidarKind::kSpinning;
  config.lidar_columns = 90;
  const std::vector<Eigen::Vector3f> points_L =
      Lidar(config, 1).scan(RayScene(room()), somePose(), 0);
  ASSERT_EQ(points_L.size(), 16u * 90u);
  for (std::size_t i = 0; i < points_L.size(); ++i) {
    const Eigen::Vector3d point_L = points_L[i].cast<double>();
    EXPECT_LT(toRoom(somePose() * point_L), 1e-4);
    const double elevation = std::asin(point_L.z() / point_L.norm());
    const double ring = static_cast<double>(i / 90);
    EXPECT_NEAR(elevation, -0.2618 + ring * 2 * 0.2618 / 15, 1e-4);
  }
}

TEST(LidarTest, LivoxPatternsCoverTheirFieldAndDiffer) {
  LidarConfig config;
  config.lidar = LidarKind::kLivox;
  config.lidar_fov_down = 0.1;
  config.lidar_fov_up = 0.8;
  Lidar lidar(config, 1);
  const RayScene scene(room());
  const auto first = lidar.scan(scene, somePose(), 0);
  const auto second = lidar.scan(scene, somePose(), 1);
  ASSERT_EQ(first.size(), 16u * 900u);
  ASSERT_EQ(second.size(), first.size());
  EXPECT_NE(first, second);
  std::vector<int> sectors(36, 0);
  for (const Eigen::Vector3f& point_L : first) {
    EXPECT_LT(toRoom(somePose() * point_L.cast<double>()), 1e-4);
    const double elevation = std::asin(point_L.z() / point_L.norm());
    EXPECT_GT(elevation, -0.1001);
    EXPECT_LT(elevation, 0.8001);
    const double turn = (std::atan2(point_L.y(), point_L.x()) + M_PI) / (2.0 * M_PI);
    ++sectors[static_cast<std::size_t>(std::min(turn, 0.9999) * 36)];
  }
  for (const int count : sectors) EXPECT_NEAR(count, 400, 20);
}

TEST(LidarTest, RangeHasNoiseAndAnEnd) {
  LidarConfig config;
  config.lidar = LidarKind::kSpinning;
  config.lidar_noise = 0.02;
  config.lidar_range = 4.0;
  LidarConfig exact = config;
  exact.lidar_noise = 0.0;
  const RayScene scene(room());
  const auto noisy_points = Lidar(config, 1).scan(scene, somePose(), 0);
  const auto points = Lidar(exact, 1).scan(scene, somePose(), 0);
  ASSERT_EQ(noisy_points.size(), points.size());
  ASSERT_GT(points.size(), 1000u);
  ASSERT_LT(points.size(), 16u * 900u);
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE(points[i].norm(), 4.0001f);
    const double error = noisy_points[i].norm() - points[i].norm();
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(points.size())), 0.02, 0.002);
}

}  // namespace
}  // namespace fiimap::sim
