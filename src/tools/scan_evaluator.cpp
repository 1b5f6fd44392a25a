#include "scan_evaluator.h"

#include <iostream>
#include <stdexcept>

#include "bag_player.h"

namespace fiimap {

nlohmann::json toJson(const ScanCounters& counters) {
  nlohmann::json out;
  out["scans"] = counters.received;
  out["integrated"] = counters.integrated;
  out["dropped"] = nlohmann::json::object();
  for (int i = 0; i < kDropReasonCount; ++i) {
    const auto reason = static_cast<DropReason>(i);
    if (counters.dropped(reason) > 0) out["dropped"][nameOf(reason)] = counters.dropped(reason);
  }
  return out;
}

void ScanEvaluator::play(const EvaluationInput& input) {
  BagPlayer player(input.bag(), input.topics(), input.node());
  total_ = player.scans();
  sensors_ = input.node().allSensors();
  ProgressBar progress(total_);
  progress_ = &progress;
  player.play(this, &counters_);
  progress_ = nullptr;
  if (!counters_.conserved()) {
    throw std::logic_error("scans were lost: " + std::to_string(counters_.received) +
                           " received, " + std::to_string(counters_.integrated) + " integrated, " +
                           std::to_string(counters_.dropped()) + " dropped");
  }
  if (counters_.integrated > 0) return;
  progress.end();
  throw std::runtime_error("no scan could be integrated: " + (counters_.received == 0
                                                                  ? "the recording holds none"
                                                                  : counters_.last_drop));
}

void ScanEvaluator::printWarnings() const {
  for (const std::string& warning : warnings_) std::cerr << "warning: " << warning << '\n';
}

void ScanEvaluator::onScan(const SynchronizedScan& scan) {
  try {
    addScan(scan, counters_.integrated + counters_.dropped());
    counters_.countIntegrated(scan.sensor);
  } catch (const InputError& error) {
    onDrop(error.drop(), scan.sensor);
  }
  progress_->show(counters_.received);
}

void ScanEvaluator::onDrop(const Drop& drop, std::size_t sensor) {
  Drop named = drop;
  named.sensor = sensors_.at(sensor).name;
  counters_.countDrop(named, sensor);
  warnOnce(named.text(), named.sensor + nameOf(named.reason));
}

void ScanEvaluator::onTimeJump(const std::string& what) {
  warnOnce(what, "jump");
  forget();
}

void ScanEvaluator::warnOnce(const std::string& text, const std::string& kind) {
  if (warned_.insert(kind).second) warnings_.push_back(text);
}

}  // namespace fiimap
