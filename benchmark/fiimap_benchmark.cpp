// Google Benchmark of each stage, of whole pipelines and of inflation, over recorded frames:
//   fiimap_benchmark --bag NAME=FILE [--frames N] [Google Benchmark's options]
// Times are CPU time of the thread.

#include <benchmark/benchmark.h>

#include <boost/program_options.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
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

constexpr int kReach = 2;                            // voxels
constexpr double kResolutions[] = {0.2, 0.1, 0.05};  // m
constexpr double kInflationResolution = 0.1;         // m
constexpr int kMaxReach = 10;                        // voxels
/// A frame of the searches takes seconds beyond.
constexpr int kMaxBfsReach = 4;  // voxels
constexpr std::size_t kDefaultFrames = 100;
constexpr double kSecond = 1e6;  // us

const std::vector<std::pair<Stage, std::string>>& stages() {
  static const std::vector<std::pair<Stage, std::string>> list = {
      {Stage::kProject, "project"}, {Stage::kSlide, "slide"},     {Stage::kCast, "cast"},
      {Stage::kFuse, "fuse"},       {Stage::kInflate, "inflate"}, {Stage::kSnapshot, "snapshot"},
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
    const Frame& frame = recording.frames[next++];
    state.SetIterationTime(microsecondsOf([&] { method->integrate(frame); }) / kSecond);
  }
}

using MakeReplay = std::function<std::unique_ptr<InflationReplay>()>;

/// All steps of the recording, from an empty map on, are one iteration; times are per frame.
void runInflation(benchmark::State& state, const std::vector<InflationStep>& steps,
                  const MakeReplay& make) {
  for (auto _ : state) {
    const std::unique_ptr<InflationReplay> replay = make();
    double time = 0.0;
    for (const InflationStep& step : steps) {
      replay->prepare(step);
      time += microsecondsOf([&] { replay->update(); });
    }
    state.SetIterationTime(time / kSecond / steps.size());
  }
}

/// Points around the vehicle, as a trajectory optimiser would ask for them.
std::vector<Eigen::Vector3d> spiralAround(const Eigen::Vector3d& center_W) {
  constexpr int kPoints = 1000;
  constexpr double kTurn = 0.1, kGrowth = 0.003;  // rad and m from point to point
  std::vector<Eigen::Vector3d> points_W;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i * kTurn, radius = i * kGrowth;
    points_W.push_back(center_W + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  return points_W;
}

void runQuery(benchmark::State& state, const Recording& recording, double resolution) {
  Mapper mapper(configAt(resolution, kReach));
  for (const Frame& frame : recording.frames) {
    mapper.integrate(frame.image.view, frame.intrinsics, frame.pose);
  }
  const std::shared_ptr<const Snapshot> snapshot = mapper.snapshot();
  const std::vector<Eigen::Vector3d> points_W =
      spiralAround(recording.frames.back().pose.vehicle_W);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(snapshot->inflation(points_W[i]));
    i = i + 1 < points_W.size() ? i + 1 : 0;  // a division takes as long as half a query
  }
}

std::string nameOf(const std::string& what, const Recording& recording, double resolution) {
  std::ostringstream name;
  name << what << '/' << recording.name << '/' << resolution << 'm';
  return name.str();
}

/// A fixed number of iterations: Google Benchmark would otherwise repeat the whole pipeline until a
/// stage of microseconds has taken its share of a second.
template <typename... Arguments>
void add(const std::string& name, std::size_t iterations, Arguments&&... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), std::forward<Arguments>(arguments)...)
      ->UseManualTime()
      ->Iterations(iterations)
      ->Unit(benchmark::kMicrosecond);
}

void addPipelines(const Recording& recording) {
  for (const double resolution : kResolutions) {
    for (const auto& [stage, stage_name] : stages()) {
      add(nameOf(stage_name, recording, resolution), recording.frames.size(), runStage,
          std::cref(recording), resolution, stage);
    }
    for (const char* method : {kFiimap, kEgoStyle, kPerPixel, kOctomap}) {
      add(nameOf(std::string("pipeline/") + method, recording, resolution), recording.frames.size(),
          runPipeline, std::cref(recording), resolution, std::string(method));
    }
    benchmark::RegisterBenchmark(nameOf("query", recording, resolution).c_str(), runQuery,
                                 std::cref(recording), resolution);
  }
}

void addInflation(const Recording& recording, const std::vector<InflationStep>& steps) {
  for (int reach = 1; reach <= kMaxReach; ++reach) {
    const MapperConfig config = configAt(kInflationResolution, reach);
    const auto add_method = [&](const std::string& name, const MakeReplay& make) {
      add("inflation/" + name + "/" + recording.name + "/L" + std::to_string(reach), 1,
          runInflation, std::cref(steps), make);
    };
    add_method("incremental", [config] { return std::make_unique<InflaterReplay>(config); });
    const VoxelBox box = boxAroundFrames(config, recording.frames);
    add_method("byte_batch", [config, box] { return std::make_unique<BatchReplay>(config, box); });
    if (reach > kMaxBfsReach) continue;
    MapperConfig bfs_config = config;
    bfs_config.inflation_method = InflationMethod::kBfs;
    add_method("bfs", [bfs_config] { return std::make_unique<InflaterReplay>(bfs_config); });
  }
}

/// Takes our own options out of the arguments, leaving Google Benchmark's.
std::vector<Recording> loadRecordings(int* argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description description;
  auto add_option = description.add_options();
  add_option("bag", po::value<std::vector<std::string>>()->required(), "NAME=FILE");
  add_option("frames", po::value<std::size_t>()->default_value(kDefaultFrames), "");
  const po::parsed_options parsed =
      po::command_line_parser(*argc, argv).options(description).allow_unregistered().run();
  po::variables_map values;
  po::store(parsed, values);
  po::notify(values);

  static std::vector<std::string> others;
  others = po::collect_unrecognized(parsed.options, po::include_positional);
  *argc = 1;
  for (std::string& other : others) argv[(*argc)++] = other.data();

  std::vector<Recording> recordings;
  for (const std::string& bag : values["bag"].as<std::vector<std::string>>()) {
    recordings.push_back(loadRecording(bag, values["frames"].as<std::size_t>()));
  }
  return recordings;
}

int run(int argc, char** argv) {
  const std::vector<Recording> recordings = loadRecordings(&argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  std::vector<std::vector<InflationStep>> steps;
  for (const Recording& recording : recordings) {
    steps.push_back(recordInflationSteps(recording.frames, configAt(kInflationResolution, 1)));
  }
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    addPipelines(recordings[i]);
    addInflation(recordings[i], steps[i]);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace fiimap::bench

int main(int argc, char** argv) {
  try {
    return fiimap::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "fiimap_benchmark: " << error.what() << '\n';
    return 1;
  }
}
