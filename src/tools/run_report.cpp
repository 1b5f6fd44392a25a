#include "run_report.h"

#include <cstdio>
#include <functional>
#include <utility>

#include "quantiles.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

constexpr double kBytesPerMegabyte = 1e6;

using Getter = std::function<double(const ScanReport&)>;

const std::vector<std::pair<std::string, double StageTimes::*>>& stages() {
  static const std::vector<std::pair<std::string, double StageTimes::*>> list = {
      {"project", &StageTimes::project}, {"slide", &StageTimes::slide},
      {"raycast", &StageTimes::raycast}, {"fuse", &StageTimes::fuse},
      {"inflate", &StageTimes::inflate}, {"snapshot", &StageTimes::snapshot},
  };
  return list;
}

nlohmann::json quantiles(const std::vector<ScanReport>& scans, const Getter& get) {
  std::vector<double> values;
  for (const ScanReport& scan : scans) values.push_back(get(scan));
  const Quantiles q = quantilesOf(std::move(values));
  return {{"median", q.median}, {"p95", q.p95}, {"max", q.max}};
}

std::string tableRow(const std::string& name, const nlohmann::json& values) {
  char row[96];
  std::snprintf(row, sizeof(row), "  %-14s %10.3f %10.3f %10.3f\n", name.c_str(),
                values["median"].get<double>(), values["p95"].get<double>(),
                values["max"].get<double>());
  return row;
}

}  // namespace

void RunReport::add(const ScanReport& scan) { scans_.push_back(scan); }

void RunReport::addVerification(std::int64_t mismatches) {
  ++verified_;
  mismatches_ += mismatches;
}

void RunReport::finish(const ScanCounters& counters, const Snapshot& snapshot,
                       std::size_t memory_bytes) {
  counters_ = counters;
  occupied_ = snapshot.count(Plane::kOccupied);
  inflated_ = snapshot.count(Plane::kInflated);
  window_voxels_ = snapshot.window().volume();
  memory_bytes_ = memory_bytes;
}

nlohmann::json RunReport::json() const {
  nlohmann::json out = toJson(counters_);
  out["total_ms"] = quantiles(scans_, [](const ScanReport& s) { return s.times_ms.total(); });
  for (const auto& [name, stage] : stages()) {
    out["stages_ms"][name] =
        quantiles(scans_, [stage = stage](const ScanReport& s) { return s.times_ms.*stage; });
  }
  out["change_score"] =
      quantiles(scans_, [](const ScanReport& s) { return static_cast<double>(s.changeScore()); });
  out["occupied"] = occupied_;
  out["inflated"] = inflated_;
  out["memory_bytes"] = memory_bytes_;
  out["bytes_per_voxel"] = static_cast<double>(memory_bytes_) / window_voxels_;
  out["verified"] = verified_;
  out["mismatches"] = mismatches_;
  return out;
}

std::string RunReport::text() const {
  const nlohmann::json figures = json();
  std::string text = "scans " + std::to_string(counters_.received) + ", integrated " +
                     std::to_string(counters_.integrated) + ", dropped " +
                     std::to_string(counters_.dropped());
  for (const auto& [reason, count] : figures["dropped"].items()) {
    text += " (" + reason + " " + count.dump() + ")";
  }
  text += "\n  per scan           median        p95        max\n";
  for (const auto& [name, stage] : stages()) {
    text += tableRow(name + " ms", figures["stages_ms"][name]);
  }
  text += tableRow("total ms", figures["total_ms"]);
  text += tableRow("change score", figures["change_score"]);
  char memory[96];
  std::snprintf(memory, sizeof(memory), "%.1f MB, %.3f bytes per voxel of the window",
                memory_bytes_ / kBytesPerMegabyte, figures["bytes_per_voxel"].get<double>());
  text += "occupied " + std::to_string(occupied_) + ", inflated " + std::to_string(inflated_) +
          " voxels; memory " + memory + "\n";
  if (verified_ > 0) {
    text += "compared with brute force at " + std::to_string(verified_) +
            " scans: " + std::to_string(mismatches_) + " voxels differ\n";
  }
  return text;
}

}  // namespace fiimap
