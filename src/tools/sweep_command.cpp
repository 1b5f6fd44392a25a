#include "sweep_command.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

#include "baselines/inflation_replay.h"
#include "baselines/interleave.h"
#include "baselines/thread_clock.h"
#include "fiimap/parameters.h"
#include "quantiles.h"
#include "scan_evaluator.h"
#include "sweep_report.h"

namespace fiimap {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;

/// Every change of the occupied layer at one resolution.
struct ResolutionSteps {
  MapperConfig config;
  std::vector<bench::InflationStep> steps;
  VoxelBox box;  // around all update boxes
};

/// Records the changes at all resolutions in one pass through the recording.
class StepCollector : public ScanEvaluator {
 public:
  StepCollector(const MapperConfig& config, const std::vector<double>& resolutions) {
    for (const double resolution : resolutions) {
      MapperConfig changed = config;
      changed.resolution = resolution;
      changed.inflation_radius = resolution;
      recorders_.emplace_back(changed);
      all_.push_back({changed, {}, {}});
    }
  }

  const std::vector<ResolutionSteps>& all() const { return all_; }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    const bench::Frame frame = bench::frameOf(scan, all_.front().config.pixel_step);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      all_[i].steps.push_back(recorders_[i].add(frame));
      all_[i].box = bench::boxAround(all_[i].box, all_[i].steps.back().update_box);
    }
  }

  void forget() override {
    throw std::runtime_error("the recording begins anew, which cannot be replayed");
  }

  std::vector<bench::InflationRecorder> recorders_;
  std::vector<ResolutionSteps> all_;
};

struct Contender {
  SweepRow row;
  std::unique_ptr<bench::InflationReplay> replay;
  std::vector<double> times_us;
  double used_us = 0.0;
};

/// All methods of one resolution, shape and reach take turns.
std::vector<SweepRow> race(const ResolutionSteps& recorded, const std::string& shape, int reach,
                           const std::vector<std::string>& methods, double seconds) {
  MapperConfig config = recorded.config;
  config.inflation_radius = reach * config.resolution;
  applyParameters({{"inflation_shape", shape}}, mapperParameters(&config));
  config.validate();
  std::vector<Contender> contenders;
  for (const std::string& method : methods) {
    contenders.push_back({{config.resolution, shape, reach, method, 0, {}},
                          bench::makeReplay(method, config, recorded.box),
                          {},
                          0.0});
  }
  bench::interleave(contenders.size(), recorded.steps.size(), [&](std::size_t i, std::size_t step) {
    Contender& contender = contenders[i];
    if (contender.used_us > seconds * kMicrosecondsPerSecond) return;
    contender.replay->prepare(recorded.steps[step]);
    const double time_us = bench::microsecondsOf([&] { contender.replay->update(); });
    contender.times_us.push_back(time_us);
    contender.used_us += time_us;
  });
  std::vector<SweepRow> rows;
  for (Contender& contender : contenders) {
    contender.row.updates = contender.times_us.size();
    contender.row.time_us = quantilesOf(std::move(contender.times_us));
    rows.push_back(contender.row);
  }
  return rows;
}

std::vector<SweepRow> sweep(const std::vector<ResolutionSteps>& recordings,
                            const SweepOptions& options, const std::vector<std::string>& methods) {
  std::vector<SweepRow> rows;
  ProgressBar progress(recordings.size() * options.shapes.size() * options.reaches.size());
  std::size_t done = 0;
  for (const ResolutionSteps& recorded : recordings) {
    for (const std::string& shape : options.shapes) {
      for (const int reach : options.reaches) {
        const auto more = race(recorded, shape, reach, methods, options.seconds);
        rows.insert(rows.end(), more.begin(), more.end());
        progress.show(++done);
      }
    }
  }
  return rows;
}

nlohmann::json changeScores(const std::vector<ResolutionSteps>& recordings) {
  nlohmann::json json = nlohmann::json::array();
  for (const ResolutionSteps& recorded : recordings) {
    std::vector<double> scores;
    for (const auto& step : recorded.steps) scores.push_back(static_cast<double>(step.score()));
    const Quantiles q = quantilesOf(std::move(scores));
    json.push_back({{"resolution", recorded.config.resolution},
                    {"median", q.median},
                    {"p95", q.p95},
                    {"max", q.max}});
  }
  return json;
}

/// Bad words are found before the recording is read.
void check(const SweepOptions& options) {
  if (options.seconds <= 0.0) throw std::invalid_argument("--seconds must be more than 0");
  for (const int reach : options.reaches) {
    if (reach < 1) throw std::invalid_argument("--reaches must be at least 1");
  }
  MapperConfig config;
  for (const std::string& shape : options.shapes) {
    applyParameters({{"inflation_shape", shape}}, mapperParameters(&config));
  }
  for (const std::string& method : options.methods) {
    bench::makeReplay(method, config, {VoxelIndex::Zero(), VoxelIndex::Ones()});
  }
}

}  // namespace

int sweepInflation(const SweepOptions& options) {
  check(options);
  std::vector<std::string> methods = options.methods;
  if (methods.empty()) methods.assign(std::begin(bench::kInflations), std::end(bench::kInflations));
  const EvaluationInput input(options.input);
  input.requireOneSensor();
  StepCollector collector(input.mapper(), options.resolutions);
  collector.play(input);
  collector.printWarnings();

  const std::vector<SweepRow> rows = sweep(collector.all(), options, methods);
  std::cout << toText(rows, options.csv);
  nlohmann::json json = toJson(collector.counters());
  json["warnings"] = collector.warnings();
  json["clock"] = "CPU time of the thread";
  json["change_score"] = changeScores(collector.all());
  json["results"] = nlohmann::json::array();
  for (const SweepRow& row : rows) json["results"].push_back(toJson(row));
  input.writeJson(json);
  return 0;
}

}  // namespace fiimap
