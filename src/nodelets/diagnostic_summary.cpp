#include "diagnostic_summary.h"

#include <algorithm>

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace fiimap {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string missingAt(const SensorTopics& topics, const SensorTotals& now) {
  if (now.scans == 0) return "no scans received on " + topics.scans;
  if (!topics.camera_infos.empty() && now.camera_infos == 0) {
    return "no camera_info received on " + topics.camera_infos;
  }
  return "";
}

/// What one sensor's scans do; the text is empty when all is well.
DiagnosticSummary summarizeScans(const ScanCounters& before, const ScanCounters& now) {
  if (now.dropped() == before.dropped()) return {DiagnosticStatus::OK, ""};
  if (now.integrated == before.integrated) {
    return {DiagnosticStatus::ERROR, "all scans dropped: " + now.last_drop};
  }
  return {DiagnosticStatus::WARN, "scans dropped: " + now.last_drop};
}

void add(const std::string& text, std::string* texts) {
  if (!text.empty()) *texts += (texts->empty() ? "" : "; ") + text;
}

/// The counters of a sensor: where there is one only, those of all scans.
const ScanCounters& countersOf(const ScanCounters& all, std::size_t sensor) {
  return all.sensors.empty() ? all : all.sensors.at(sensor);
}

std::string named(const std::string& sensor, const std::string& text) {
  return sensor.empty() || text.empty() ? text : sensor + ": " + text;
}

}  // namespace

std::string missingInput(const InputTopics& topics, const InputTotals& now) {
  std::string missing;
  for (std::size_t i = 0; i < topics.sensors.size(); ++i) {
    add(named(topics.sensors[i].name, missingAt(topics.sensors[i], now.sensors[i])), &missing);
  }
  if (now.poses == 0) add("no poses received on " + topics.poses, &missing);
  return missing.empty() ? "" : missing + ": check that it is published and remapped";
}

DiagnosticSummary summarizeInputs(const InputTopics& topics, const InputTotals& before,
                                  const InputTotals& now) {
  DiagnosticSummary summary = {DiagnosticStatus::OK, missingInput(topics, now)};
  if (!summary.text.empty()) summary.level = DiagnosticStatus::ERROR;
  if (now.poses == 0) return summary;  // no scan can be used, whatever becomes of it
  for (std::size_t i = 0; i < topics.sensors.size(); ++i) {
    const SensorTopics& sensor = topics.sensors[i];
    if (!missingAt(sensor, now.sensors[i]).empty()) continue;
    DiagnosticSummary own =
        summarizeScans(countersOf(before.counters, i), countersOf(now.counters, i));
    if (now.sensors[i].scans == before.sensors[i].scans) {
      own = {DiagnosticStatus::ERROR, "scans stopped on " + sensor.scans};
    }
    summary.level = std::max(summary.level, own.level);
    add(named(sensor.name, own.text), &summary.text);
  }
  if (summary.text.empty()) summary.text = "scans and poses come in";
  return summary;
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
