#include "accuracy_command.h"

#include <iostream>
#include <memory>
#include <stdexcept>

#include "accuracy_report.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/scan_decoder.h"
#include "held_out_split.h"
#include "reading_projector.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

/// Builds one map per resolution from the scans that are not held out.
class CrossValidation : public ScanEvaluator {
 public:
  CrossValidation(const MapperConfig& config, const std::vector<double>& resolutions,
                  const HeldOutSplit& split, int held_out_step)
      : split_(split), projector_(config, held_out_step) {
    for (const double resolution : resolutions) {
      MapperConfig changed = config;
      changed.resolution = resolution;
      candidates_.push_back({std::make_unique<Mapper>(changed), {}});
    }
  }

  /// `final_map`: the map that all building scans of the recording made, against every held-out
  /// scan. `online`: the map of the building scans before the held-out scan, as a vehicle has it
  /// when it takes that scan.
  std::vector<AccuracyRow> finish() const {
    std::vector<AccuracyRow> rows;
    for (const Candidate& candidate : candidates_) {
      const std::shared_ptr<const Snapshot> map = candidate.mapper->snapshot();
      std::vector<ScanPrediction> at_the_end;
      for (const RangeData& scan : held_out_) at_the_end.push_back(predict(*map, scan));
      const double resolution = candidate.mapper->config().resolution;
      rows.push_back(summarise("final_map", resolution, at_the_end));
      rows.push_back(summarise("online", resolution, candidate.online));
    }
    return rows;
  }

  std::size_t heldOut() const { return held_out_.size(); }

 private:
  struct Candidate {
    std::unique_ptr<Mapper> mapper;
    std::vector<ScanPrediction> online;
  };

  void addScan(const SynchronizedScan& scan, std::size_t index) override {
    if (!split_.holdsOut(index)) {
      for (Candidate& candidate : candidates_) decoder_.integrate(scan, candidate.mapper.get());
      return;
    }
    RangeData readings;
    projector_.project(scan, &readings);
    readings.misses = {};  // not looked at, and all held-out scans are kept
    for (Candidate& candidate : candidates_) {
      candidate.online.push_back(predict(*candidate.mapper->snapshot(), readings));
    }
    held_out_.push_back(std::move(readings));
  }

  void forget() override {
    held_out_.clear();
    for (Candidate& candidate : candidates_) {
      candidate.mapper->reset();
      candidate.online.clear();
    }
  }

  HeldOutSplit split_;
  ReadingProjector projector_;
  ScanDecoder decoder_;
  std::vector<Candidate> candidates_;
  std::vector<RangeData> held_out_;
};

HeldOutSplit splitFrom(const AccuracyOptions& options) {
  if (!options.split.empty()) return HeldOutSplit::fromFile(options.split);
  return HeldOutSplit::byFold(options.fold == -1 ? options.folds - 1 : options.fold, options.folds);
}

}  // namespace

int evaluateAccuracy(const AccuracyOptions& options) {
  if (options.held_out_step < 1) throw std::invalid_argument("--held-out-step must be at least 1");
  const HeldOutSplit split = splitFrom(options);
  const EvaluationInput input(options.input);
  std::vector<double> resolutions = options.resolutions;
  if (resolutions.empty()) resolutions = {input.mapper().resolution};
  CrossValidation validation(input.mapper(), resolutions, split, options.held_out_step);
  validation.play(input);
  const std::vector<AccuracyRow> rows = validation.finish();

  for (const std::string& warning : validation.warnings()) {
    std::cerr << "warning: " << warning << '\n';
  }
  if (!options.csv) {
    std::cout << options.input.bag << ": " << validation.heldOut() << " of "
              << validation.counters().integrated << " scans held out (" << split.text() << ")\n";
  }
  std::cout << toText(rows, options.csv);
  nlohmann::json json = toJson(validation.counters());
  json["warnings"] = validation.warnings();
  json["split"] = split.text();
  json["held_out_step"] = options.held_out_step;
  json["results"] = nlohmann::json::array();
  for (const AccuracyRow& row : rows) json["results"].push_back(toJson(row));
  input.writeJson(json);
  if (validation.heldOut() == 0) {
    std::cerr << "error: no scan could be held out\n";
    return 1;
  }
  return 0;
}

}  // namespace fiimap
