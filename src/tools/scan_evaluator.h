#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "evaluation_input.h"
#include "fiimap/ros/scan_counters.h"
#include "fiimap/ros/scan_synchronizer.h"
#include "progress_bar.h"

namespace fiimap {

/// `scans`, `integrated` and `dropped` (by reason).
nlohmann::json toJson(const ScanCounters& counters);

/// Goes through the scans of a recording: counts them, shows progress and keeps what the user
/// should be told. A command derives from it and says what to do with a scan.
class ScanEvaluator : private ScanListener {
 public:
  /// Plays the whole recording.
  /// \throws std::runtime_error that tells why, when no scan could be used.
  void play(const EvaluationInput& input);

  const ScanCounters& counters() const { return counters_; }
  /// Each kind of trouble once; the counters tell how often.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// On standard error, a line each.
  void printWarnings() const;

 protected:
  /// Takes one scan. \param index in the recording; scans that are dropped count.
  /// \throws InputError when it cannot be used.
  virtual void addScan(const SynchronizedScan& scan, std::size_t index) = 0;
  /// The recording began anew: everything before must be forgotten.
  virtual void forget() = 0;
  /// Scans in the recording.
  std::size_t total() const { return total_; }

 private:
  void onScan(const SynchronizedScan& scan) override;
  void onDrop(const Drop& drop, std::size_t sensor) override;
  void onTimeJump(const std::string& what) override;
  void onWarning(const std::string& text) override { warnOnce(text, text); }

  void warnOnce(const std::string& text, const std::string& kind);

  std::vector<SensorConfig> sensors_;
  ScanCounters counters_;
  std::size_t total_ = 0;
  ProgressBar* progress_ = nullptr;
  std::set<std::string> warned_;
  std::vector<std::string> warnings_;
};

}  // namespace fiimap
