#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "diagnostic_summary.h"
#include "input_subscriber.h"
#include "mapping_thread.h"

namespace fiimap {

/// Tells on /diagnostics what comes in, what becomes of it and, when no map is being made, why.
/// onUpdate() and onReset() may be called from any thread, publish() from one at a time.
class MappingDiagnostics {
 public:
  /// \param inputs must outlive this object; \param counters where the scan counters come from.
  MappingDiagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const std::string& name, const InputSubscriber& inputs,
                     std::function<ScanCounters()> counters);

  void onUpdate(const MapUpdate& update);
  void onReset();

  /// Publishes the state of now and of the time since the last call.
  /// \return what to warn the user of, because an input never came; empty when all is well.
  std::string publish();

 private:
  using Clock = std::chrono::steady_clock;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  struct Totals : InputTotals {
    Clock::time_point time;
  };

  Totals totals() const;
  void reportInputs(Status& status);
  void reportMap(Status& status);
  void addRate(const std::string& key, std::uint64_t before, std::uint64_t now,
               Status* status) const;
  static void addTopics(const std::string& prefix, const SensorTopics& topics, Status* status);
  void addRates(const std::string& prefix, const SensorTotals& before, const SensorTotals& now,
                Status* status) const;
  static void addCounters(const std::string& prefix, const ScanCounters& counters, Status* status);
  static void addUpdate(const MapUpdate& update, Status* status);

  const InputSubscriber& inputs_;
  std::function<ScanCounters()> counters_;
  Totals before_;
  Totals now_;

  std::mutex mutex_;
  std::optional<MapUpdate> update_;
  Clock::time_point updated_;

  diagnostic_updater::Updater updater_;
};

}  // namespace fiimap
