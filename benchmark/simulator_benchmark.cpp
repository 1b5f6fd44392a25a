// What the simulator costs: run with one free core, and compare the column CPU.

#include <benchmark/benchmark.h>

#include <cmath>

#include "depth_camera.h"
#include "depth_noise.h"
#include "lidar.h"
#include "simulator.h"

namespace {

using namespace fiimap::sim;  // NOLINT: all of it is the simulator's

constexpr int kPlaces = 100;

World worldOf(const benchmark::State& state) {
  WorldConfig config;
  config.world = static_cast<WorldKind>(state.range(0));
  return makeWorld(config);
}

/// On the way from start to goal, looking to the left and right in turns.
Eigen::Isometry3d placeOf(const World& world, std::int64_t number) {
  const double share = static_cast<double>(number % kPlaces) / kPlaces;
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  T_W_B.translation() = world.start_W + share * (world.goal_W - world.start_W);
  T_W_B.linear() =
      Eigen::AngleAxisd(0.5 * std::sin(static_cast<double>(number)), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  return T_W_B;
}

void renderDepth(benchmark::State& state) {
  const RayScene scene(worldOf(state));
  const CameraConfig config;
  DepthCamera camera(config);
  const bool noisy = state.range(1) != 0;
  const DepthNoise noise({}, config.focalLength(), 1);
  std::int64_t number = 0;
  for (auto _ : state) {
    const Eigen::Isometry3d T_W_C = placeOf(scene.world(), number++) * config.T_B_C();
    DepthFrame frame = camera.render(scene, T_W_C, noisy);
    if (noisy) noise.apply(static_cast<std::uint64_t>(number), &frame);
    benchmark::DoNotOptimize(toMillimetres(frame, config.min_range, config.max_range));
  }
}

void scanLidar(benchmark::State& state) {
  const RayScene scene(worldOf(state));
  LidarConfig config;
  config.lidar = static_cast<LidarKind>(state.range(1));
  Lidar lidar(config, 1);
  std::int64_t number = 0;
  for (auto _ : state) {
    const Eigen::Isometry3d T_W_L = placeOf(scene.world(), number++);
    benchmark::DoNotOptimize(lidar.scan(scene, T_W_L, static_cast<std::uint64_t>(number)));
  }
}

/// A step of 1/300 s with its clearance.
void flyStep(benchmark::State& state) {
  SimulatorConfig config;
  config.world.world = static_cast<WorldKind>(state.range(0));
  config.world.moving_obstacles = static_cast<int>(state.range(1));
  Simulator simulator(config);
  for (auto _ : state) {
    simulator.advance();
    benchmark::DoNotOptimize(simulator.odometry());
  }
}

constexpr int kForest = static_cast<int>(WorldKind::kForest);
constexpr int kCorridor = static_cast<int>(WorldKind::kCorridor);

BENCHMARK(renderDepth)
    ->ArgNames({"world", "noise"})
    ->Args({kForest, 0})
    ->Args({kForest, 1})
    ->Args({kCorridor, 0})
    ->Args({kCorridor, 1})
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK(scanLidar)
    ->ArgNames({"world", "kind"})
    ->Args({kForest, static_cast<int>(LidarKind::kSpinning)})
    ->Args({kForest, static_cast<int>(LidarKind::kLivox)})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(flyStep)
    ->ArgNames({"world", "moving"})
    ->Args({kForest, 0})
    ->Args({kForest, 10})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
