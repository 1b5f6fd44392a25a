#include "compare_command.h"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "compare_report.h"
#include "update_comparison.h"

namespace fiimap {
namespace {

/// Bad names are found before the recording is read.
void check(const CompareOptions& options, const MapperConfig& config) {
  const VoxelBox one_voxel = {VoxelIndex::Zero(), VoxelIndex::Ones()};
  UpdateComparison(config, options.methods, one_voxel);
}

bool needsArrays(const std::string& method) {
  return method == bench::kByteBatch || bench::isArrayMap(method);
}

VoxelBox boxFor(const CompareOptions& options, const EvaluationInput& input) {
  if (std::none_of(options.methods.begin(), options.methods.end(), needsArrays)) return {};
  PathBox path(input.mapper());
  path.play(input);
  return path.box();
}

}  // namespace

int compareMethods(const CompareOptions& options) {
  const EvaluationInput input(options.input);
  input.requireOneSensor();
  check(options, input.mapper());
  UpdateComparison comparison(input.mapper(), options.methods, boxFor(options, input));
  comparison.play(input);
  comparison.finish();
  comparison.printWarnings();

  const std::optional<MapAgreement> agreement = comparison.agreement();
  if (options.csv) {
    std::cout << toCsv(comparison);
  } else {
    std::cout << toText(comparison);
    if (agreement) std::cout << toText({*agreement});
  }
  nlohmann::json json = toJson(comparison.counters());
  json.update(summaryOf(comparison));
  json["warnings"] = comparison.warnings();
  if (agreement) json["octomap_agreement"] = toJson(*agreement);
  input.writeJson(json);
  return 0;
}

}  // namespace fiimap
