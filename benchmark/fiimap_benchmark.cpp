// Google Benchmark of each stage, of whole pipelines and of inflation, over recorded frames:
//   fiimap_benchmark --bag NAME=FILE [--frames N] [Google Benchmark's options]
// Times are CPU time of the thread.

#include <benchmark/benchmark.h>

#include <boost/program_options.hpp>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "inflation_replay.h"
#include "mapping_method.h"
#include "recording.h"
#include "staged_pipeline.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

constexpr int kReach = 2;                         // voxels
constexpr double kResolutions[] = {0.2, 0.1, 0.05};  // m
constexpr double kInflationResolution = 0.1;      // m
constexpr int kMaxReach = 10;                     // voxels
constexpr double kSecond = 1e6;                   // us

const std::vector<std::pair<Stage, std::string>>& stages() {
  static const std::vector<std::pair<Stage, std::string>> list = {
      {Stage::kProject, "project"}, {Stage::kSlide, "slide"},
      {Stage::kCast, "cast"},       {Stage::kFuse, "fuse"},
      {Stage::kInflate, "inflate"}, {Stage::kSnapshot, "snapshot"},
  };
  return list;
}

void runStage(benchmark::State& state, const Recording& recording, double resolution, Stage stage) {
  StagedPipeline pipeline(configAt(resolution, kReach), recording.frames);
  for (auto _ : state) {
    state.SetIterationTime(pipeline.integrateNext()[static_cast<int>(stage)] / kSecond);
  }
}

void runPipeline(benchmark::State& state, const Recording& recording, double resolution,
                 const std::string& name) {
  const MapperConfig config = configAt(resolution, kReach);
  const auto method = makeMethod(name, config, recording.frames);
  std::size_t next = 0;
  for (auto _ : state) {
    const Frame& frame = recording.frames[next++ % recording.frames.size()];
    state.SetIterationTime(microsecondsOf([&] { method->integrate(frame); }) / kSecond);
  }
}

/// All steps of the recording, from an empty map on, are one iteration; times are per frame.
void runInflation(benchmark::State& state, const Recording& recording,
                  const std::vector<InflationStep>& steps, InflationMethod method, int reach) {
  MapperConfig config = configAt(kInflationResolution, reach);
  config.inflation_method = method;
  for (auto _ : state) {
    InflaterReplay replay(config);
    double time = 0.0;
    for (const InflationStep& step : steps) {
      replay.prepare(step);
      time += microsecondsOf([&] { replay.update(); });
    }
    state.SetIterationTime(time / kSecond / recording.frames.size());
  }
}

void runByteBatch(benchmark::State& state, const Recording& recording,
                  const std::vector<InflationStep>& steps, int reach) {
  const MapperConfig config = configAt(kInflationResolution, reach, ElementShape::kCube);
  BatchReplay replay(config, boxAroundFrames(config, recording.frames));
  std::size_t next = 0;
  for (auto _ : state) {
    // After the last step the first one again: the map is then not that of the recording, but as
    // full of obstacles.
    replay.prepare(steps[next++ % steps.size()]);
    state.SetIterationTime(microsecondsOf([&] { replay.update(); }) / kSecond);
  }
}

void runQuery(benchmark::State& state, const Recording& recording, double resolution) {
  Mapper mapper(configAt(resolution, kReach));
  for (const Frame& frame : recording.frames) {
    mapper.integrate(frame.image.view, frame.intrinsics, frame.pose);
  }
  const std::shared_ptr<const Snapshot> snapshot = mapper.snapshot();
  // A spiral of points around the vehicle, as a trajectory optimiser would ask.
  constexpr double kTurn = 0.1, kGrowth = 0.003, kMaxRadius = 3.0;
  double angle = 0.0, radius = 0.0;
  for (auto _ : state) {
    angle += kTurn;
    radius = radius > kMaxRadius ? 0.0 : radius + kGrowth;
    const Eigen::Vector3d offset(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    benchmark::DoNotOptimize(
        snapshot->inflation(recording.frames.back().pose.vehicle_W + offset));
  }
}

}  // namespace
}  // namespace fiimap::bench
