#include "mapping_diagnostics.h"

#include <utility>

#include "fiimap/ros/steady_time.h"

namespace fiimap {
namespace {

constexpr int kPercent = 100;

const char* nameOf(Occupancy occupancy) {
  switch (occupancy) {
    case Occupancy::kFree:
      return "free";
    case Occupancy::kOccupied:
      return "occupied";
    case Occupancy::kOutside:
      return "outside of the window";
    default:
      return "unknown";
  }
}

SensorTotals sumOf(const std::vector<SensorTotals>& sensors) {
  SensorTotals sum;
  for (const SensorTotals& sensor : sensors) {
    sum.scans += sensor.scans;
    sum.camera_infos += sensor.camera_infos;
  }
  return sum;
}

}  // namespace

MappingDiagnostics::MappingDiagnostics(const ros::NodeHandle& node,
                                       const ros::NodeHandle& private_node, const std::string& name,
                                       const InputSubscriber& inputs,
                                       std::function<ScanCounters()> counters)
    : inputs_(inputs), counters_(std::move(counters)), updater_(node, private_node, name) {
  before_ = now_ = totals();
  updater_.setHardwareID("none");
  updater_.add("inputs", this, &MappingDiagnostics::reportInputs);
  updater_.add("map", this, &MappingDiagnostics::reportMap);
}

void MappingDiagnostics::onUpdate(const MapUpdate& update) {
  const std::lock_guard<std::mutex> lock(mutex_);
  update_ = update;
  updated_ = Clock::now();
}

void MappingDiagnostics::onReset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  update_.reset();
}

std::string MappingDiagnostics::publish() {
  before_ = std::exchange(now_, totals());
  // Not update(): it would be silent after simulated time went back.
  updater_.force_update();
  return missingInput(inputs_.topics(), now_);
}

MappingDiagnostics::Totals MappingDiagnostics::totals() const {
  const InputCounts& counts = inputs_.counts();
  Totals totals;
  for (const SensorCounts& sensor : counts.sensors) {
    totals.sensors.push_back({sensor.scans, sensor.camera_infos});
  }
  totals.poses = counts.poses;
  totals.counters = counters_();
  totals.time = Clock::now();
  return totals;
}

void MappingDiagnostics::reportInputs(Status& status) {
  const ScanCounters& counters = now_.counters;
  const DiagnosticSummary summary = summarizeInputs(inputs_.topics(), before_, now_);
  status.summary(summary.level, summary.text);
  addRates("", sumOf(before_.sensors), sumOf(now_.sensors), &status);
  addRate("pose rate [Hz]", before_.poses, now_.poses, &status);
  addCounters("", counters, &status);
  status.add("last drop", counters.last_drop);
  status.add("poses refused", counters.refused_poses);
  status.add("transforms refused", counters.refused_transforms);
  status.add("poses, transforms and camera infos displaced", counters.displaced_inputs);
  for (std::size_t i = 0; i < counters.sensors.size(); ++i) {
    const std::string prefix = inputs_.topics().sensors[i].name + ": ";
    addTopics(prefix, inputs_.topics().sensors[i], &status);
    addRates(prefix, before_.sensors[i], now_.sensors[i], &status);
    addCounters(prefix, counters.sensors[i], &status);
  }
}

void MappingDiagnostics::addRate(const std::string& key, std::uint64_t before, std::uint64_t now,
                                 Status* status) const {
  const double seconds = secondsBetween(before_.time, now_.time);
  status->addf(key, "%.1f", seconds > 0.0 ? static_cast<double>(now - before) / seconds : 0.0);
}

void MappingDiagnostics::addTopics(const std::string& prefix, const SensorTopics& topics,
                                   Status* status) {
  status->add(prefix + "scan topic", topics.scans);
  if (!topics.camera_infos.empty()) status->add(prefix + "camera_info topic", topics.camera_infos);
}

void MappingDiagnostics::addRates(const std::string& prefix, const SensorTotals& before,
                                  const SensorTotals& now, Status* status) const {
  addRate(prefix + "scan rate [Hz]", before.scans, now.scans, status);
  addRate(prefix + "camera_info rate [Hz]", before.camera_infos, now.camera_infos, status);
}

void MappingDiagnostics::addCounters(const std::string& prefix, const ScanCounters& counters,
                                     Status* status) {
  status->add(prefix + "scans received", counters.received);
  status->add(prefix + "scans integrated", counters.integrated);
  status->add(prefix + "scans waiting", counters.waiting);
  status->add(prefix + "scans dropped", counters.dropped());
  for (int i = 0; i < kDropReasonCount; ++i) {
    const auto reason = static_cast<DropReason>(i);
    if (counters.dropped(reason) == 0) continue;
    status->add(prefix + "dropped: " + fiimap::nameOf(reason), counters.dropped(reason));
  }
}

void MappingDiagnostics::reportMap(Status& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const DiagnosticSummary summary = summarizeMap(update_ ? &*update_ : nullptr, before_, now_);
  status.summary(summary.level, summary.text);
  if (!update_) return;
  const Snapshot& snapshot = *update_->snapshot;
  status.addf("map age [s]", "%.2f", secondsBetween(updated_, Clock::now()));
  status.add("vehicle cell", nameOf(snapshot.occupancy(update_->pose.vehicle_W)));
  status.add("vehicle cell inflated",
             snapshot.inflation(update_->pose.vehicle_W) == Inflation::kInflated);
  addUpdate(*update_, &status);
}

void MappingDiagnostics::addUpdate(const MapUpdate& update, Status* status) {
  const ReadingCount& readings = update.report.readings;
  const auto share = [&readings](std::size_t count) {
    return readings.total > 0 ? static_cast<double>(kPercent * count) / readings.total : 0.0;
  };
  status->addf("readings valid [%]", "%.1f", share(readings.total - readings.invalid));
  status->addf("readings within range [%]", "%.1f", share(readings.returns));
  status->add("rays with a hit", update.report.rays.hits);
  status->add("rays without a hit", update.report.rays.misses);
  status->add("changed voxels", update.report.changeScore());
  status->addf("pose gap [s]", "%.4f", update.pose_gap);
  status->addf("update time [ms]", "%.2f", update.report.times_ms.total());
  status->add("occupied voxels", update.snapshot->count(Plane::kOccupied));
  status->add("inflated voxels", update.snapshot->count(Plane::kInflated));
  status->addf("memory [MB]", "%.1f", static_cast<double>(update.memory_bytes) * 1e-6);
}

}  // namespace fiimap
