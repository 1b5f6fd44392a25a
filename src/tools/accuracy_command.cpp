#include "accuracy_command.h"

#include <iostream>
#include <stdexcept>

#include "cross_validation.h"

namespace fiimap {
namespace {

constexpr int kDefaultFolds = 10;

std::vector<HeldOutSplit> splitsFrom(const AccuracyOptions& options) {
  if (!options.split.empty()) return {HeldOutSplit::fromFile(options.split)};
  const int folds = options.folds == 0 ? kDefaultFolds : options.folds;
  if (options.fold != -1) return {HeldOutSplit::byFold(options.fold, folds)};
  if (options.folds == 0) return {HeldOutSplit::byFold(folds - 1, folds)};
  return HeldOutSplit::everyFold(folds);
}

std::string textOf(const std::vector<HeldOutSplit>& splits) {
  if (splits.size() == 1) return splits.front().text();
  return "index % " + std::to_string(splits.size()) + ", every fold in turn";
}

nlohmann::json jsonOf(const AccuracyOptions& options, const std::vector<HeldOutSplit>& splits,
                      const CrossValidation& validation, const std::vector<AccuracyRow>& rows,
                      const std::vector<MapAgreement>& agreements) {
  nlohmann::json json = toJson(validation.counters());
  json["warnings"] = validation.warnings();
  json["split"] = textOf(splits);
  json["folds"] = splits.size();
  json["held_out_step"] = options.held_out_step;
  json["results"] = nlohmann::json::array();
  for (const AccuracyRow& row : rows) json["results"].push_back(toJson(row));
  for (const MapAgreement& agreement : agreements) {
    json["octomap_agreement"].push_back(toJson(agreement));
  }
  return json;
}

}  // namespace

int evaluateAccuracy(const AccuracyOptions& options) {
  if (options.held_out_step < 1) throw std::invalid_argument("--held-out-step must be at least 1");
  const std::vector<HeldOutSplit> splits = splitsFrom(options);
  const EvaluationInput input(options.input);
  input.requireOneSensor();
  std::vector<double> resolutions = options.resolutions;
  if (resolutions.empty()) resolutions = {input.mapper().resolution};
  CrossValidation validation(input.mapper(), resolutions, splits, options.held_out_step,
                             options.octomap);
  validation.play(input);
  validation.printWarnings();
  if (validation.heldOut() == 0) {
    throw std::runtime_error("no scan was held out of " +
                             std::to_string(validation.counters().integrated) + " (" +
                             textOf(splits) + "); hold out more with --folds or --split");
  }

  const std::vector<AccuracyRow> rows = validation.rows();
  const std::vector<MapAgreement> agreements = validation.agreements();
  if (!options.csv) {
    std::cout << options.input.bag << ": " << validation.heldOut() << " of "
              << validation.counters().integrated << " scans held out (" << textOf(splits) << ")\n";
  }
  std::cout << toText(rows, options.csv);
  if (!options.csv) std::cout << toText(agreements);
  input.writeJson(jsonOf(options, splits, validation, rows, agreements));
  return 0;
}

}  // namespace fiimap
