#include "depth_camera.h"

#include <gtest/gtest.h>

#include "depth_noise.h"
#include "geometry_oracle.h"

namespace fiimap::sim {
namespace {

using test::kInfinity;

constexpr double kMaxError = 5e-4;  // m: single precision in worlds of tens of metres

CameraConfig smallCamera() {
  CameraConfig config;
  config.image_width = 50;  // not a multiple of the tiles
  config.image_height = 39;
  config.max_range = 60.0;  // the worlds are smaller
  return config;
}

Eigen::Isometry3d randomPose(Random* random, const Eigen::Vector3d& low,
                             const Eigen::Vector3d& high) {
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  T_W_B.translation() = test::randomPoint(random, low, high);
  T_W_B.linear() = (Eigen::AngleAxisd(random->uniform(-M_PI, M_PI), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(random->uniform(-0.6, 0.6), Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(random->uniform(-0.6, 0.6), Eigen::Vector3d::UnitX()))
                       .toRotationMatrix();
  return T_W_B;
}

Eigen::Vector3d pixelRay_C(const CameraConfig& config, int u, int v) {
  return {(u - (config.image_width - 1) / 2.0) / config.focalLength(),
          (v - (config.image_height - 1) / 2.0) / config.focalLength(), 1.0};
}

/// Where a ray passes an edge, rounding decides: then a ray a hair beside it must agree.
bool agreesWithARayBeside(double depth, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
                          const Mesh& mesh) {
  constexpr double kHair = 2e-5;
  for (const Eigen::Vector3d& shift :
       {Eigen::Vector3d(kHair, kHair, 0), Eigen::Vector3d(-kHair, kHair, 0),
        Eigen::Vector3d(0, kHair, kHair), Eigen::Vector3d(0, -kHair, kHair),
        Eigen::Vector3d(kHair, 0, -kHair), Eigen::Vector3d(-kHair, -kHair, -kHair)}) {
    const double beside = test::alongRay(origin, ray + shift, mesh);
    if (beside == depth || std::abs(beside - depth) < kMaxError * (1.0 + beside)) return true;
  }
  return false;
}

/// Every pixel, those that meet nothing too.
void expectExactImage(const RayScene& scene, double time, const CameraConfig& config,
                      const Eigen::Isometry3d& T_W_B) {
  DepthCamera camera(config);
  const Eigen::Isometry3d T_W_C = T_W_B * config.T_B_C();
  const DepthFrame& frame = camera.render(scene, T_W_C, true);
  const Mesh mesh = test::meshAt(scene.world(), time);
  int on_edges = 0;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const double depth = frame.depth[static_cast<std::size_t>(v) * frame.width + u];
      const Eigen::Vector3d ray_W = T_W_C.linear() * pixelRay_C(config, u, v);
      const double exact = test::alongRay(T_W_C.translation(), ray_W, mesh);
      if (depth == exact || std::abs(depth - exact) < kMaxError) continue;
      ++on_edges;
      ASSERT_TRUE(agreesWithARayBeside(depth, T_W_C.translation(), ray_W, mesh))
          << "pixel " << u << " " << v << ": " << depth << ", exact " << exact;
    }
  }
  EXPECT_LT(on_edges, frame.width * frame.height / 100);
}

TEST(DepthCameraTest, SeesTheWallsOfARoomWhereTheyAre) {
  World world;
  world.still.addBoxBetween({-3, -2, -1}, {5, 4, 2});
  const RayScene scene(world);
  const CameraConfig config = smallCamera();
  DepthCamera camera(config);
  Random random(11);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Isometry3d T_W_C =
        randomPose(&random, {-2.5, -1.5, -0.5}, {4.5, 3.5, 1.5}) * config.T_B_C();
    const DepthFrame& frame = camera.render(scene, T_W_C, false);
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        const Eigen::Vector3d ray_W = T_W_C.linear() * pixelRay_C(config, u, v);
        double exact = kInfinity;  // the first wall ahead
        for (int axis = 0; axis < 3; ++axis) {
          const double wall =
              ray_W[axis] > 0 ? Eigen::Vector3d(5, 4, 2)[axis] : Eigen::Vector3d(-3, -2, -1)[axis];
          exact = std::min(exact, (wall - T_W_C.translation()[axis]) / ray_W[axis]);
        }
        const double depth = frame.depth[static_cast<std::size_t>(v) * frame.width + u];
        ASSERT_NEAR(depth, exact, kMaxError) << "seed 11, round " << round;
      }
    }
  }
}

TEST(DepthCameraTest, EveryPixelIsTheExactIntersection) {
  WorldConfig config;
  config.length = 12.0;
  config.moving_obstacles = 3;
  Random random(12);
  for (const WorldKind kind :
       {WorldKind::kCorridor, WorldKind::kShelfRoom, WorldKind::kMaze, WorldKind::kForest}) {
    config.world = kind;
    config.width = kind == WorldKind::kForest ? 8.0 : 24.0;
    RayScene scene(makeWorld(config));
    const double time = random.uniform(0.0, 100.0);
    scene.setTime(time);
    const World& world = scene.world();
    for (int round = 0; round < 2; ++round) {
      const Eigen::Vector3d spread(1.0, 1.0, 0.5);
      expectExactImage(scene, time, smallCamera(),
                       randomPose(&random, world.start_W - spread, world.start_W + spread));
    }
  }
}

TEST(DepthCameraTest, TellsTheAngleOfIncidence) {
  World world;
  world.still.addBoxBetween({-50, -50, -1}, {50, 50, 0});
  const RayScene scene(world);
  CameraConfig config = smallCamera();
  config.camera_pitch = 0.9;
  DepthCamera camera(config);
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  T_W_B.translation().z() = 2.0;
  const Eigen::Isometry3d T_W_C = T_W_B * config.T_B_C();
  const DepthFrame& frame = camera.render(scene, T_W_C, true);
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const Eigen::Vector3d ray_W = (T_W_C.linear() * pixelRay_C(config, u, v)).normalized();
      EXPECT_NEAR(frame.cos_incidence[static_cast<std::size_t>(v) * frame.width + u], -ray_W.z(),
                  1e-5);
    }
  }
}

TEST(MillimetresTest, AreZeroOutOfRange) {
  DepthFrame frame;
  frame.width = 6;
  frame.height = 1;
  frame.depth = {0.19f, 0.2f, 1.2344f, 20.0f, 20.1f, std::numeric_limits<float>::infinity()};
  EXPECT_EQ(toMillimetres(frame, 0.2, 20.0),
            (std::vector<std::uint16_t>{0, 200, 1234, 20000, 0, 0}));
}

}  // namespace
}  // namespace fiimap::sim
