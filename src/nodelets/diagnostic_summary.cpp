#include "diagnostic_summary.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace fiimap {
namespace {

using diagnostic_msgs::DiagnosticStatus;

}  // namespace

std::string missingInput(const InputTopics& topics, const InputTotals& now) {
  const std::string remedy = ": check that it is published and remapped";
  if (now.scans == 0) return "no scans received on " + topics.scans + remedy;
  if (!topics.camera_infos.empty() && now.camera_infos == 0) {
    return "no camera_info received on " + topics.camera_infos + remedy;
  }
  if (now.poses == 0) return "no poses received on " + topics.poses + remedy;
  return "";
}

DiagnosticSummary summarizeInputs(const InputTopics& topics, const InputTotals& before,
                                  const InputTotals& now) {
  const std::string missing = missingInput(topics, now);
  if (!missing.empty()) return {DiagnosticStatus::ERROR, missing};
  if (now.scans == before.scans) {
    return {DiagnosticStatus::ERROR, "scans stopped on " + topics.scans};
  }
  if (now.counters.dropped() == before.counters.dropped()) {
    return {DiagnosticStatus::OK, "scans and poses come in"};
  }
  if (now.counters.integrated == before.counters.integrated) {
    return {DiagnosticStatus::ERROR, "all scans dropped: " + now.counters.last_drop};
  }
  return {DiagnosticStatus::WARN, "scans dropped: " + now.counters.last_drop};
}

DiagnosticSummary summarizeMap(const MapUpdate* update, const InputTotals& before,
                               const InputTotals& now) {
  if (update == nullptr) return {DiagnosticStatus::ERROR, "no map yet, see inputs"};
  if (now.counters.integrated == before.counters.integrated) {
    return {DiagnosticStatus::ERROR, "the map is not updated, see inputs"};
  }
  const Inflation at_vehicle = update->snapshot->inflation(update->pose.vehicle_W);
  if (at_vehicle == Inflation::kOutside) {
    return {DiagnosticStatus::ERROR,
            "the vehicle is outside of the map: see map_mode, map_center and map_size"};
  }
  if (at_vehicle == Inflation::kInflated) {
    return {DiagnosticStatus::WARN, "the vehicle is inside an obstacle or its inflation"};
  }
  if (update->report.readings.returns == 0) {
    return {DiagnosticStatus::WARN, "no reading of the newest scan is within range"};
  }
  return {DiagnosticStatus::OK, "the map is updated"};
}

}  // namespace fiimap
