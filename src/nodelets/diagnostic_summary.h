#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fiimap/ros/scan_counters.h"
#include "input_subscriber.h"
#include "mapping_thread.h"

namespace fiimap {

/// All that came in up to one moment; the difference of two tells what came in between.
struct SensorTotals {
  std::uint64_t scans = 0, camera_infos = 0;  ///< messages
};
struct InputTotals {
  std::vector<SensorTotals> sensors;
  std::uint64_t poses = 0;  ///< messages
  ScanCounters counters;
};

/// Level of diagnostic_msgs::DiagnosticStatus with the text that explains it.
struct DiagnosticSummary {
  unsigned char level = 0;
  std::string text;
};

/// What to warn the user of, because inputs never came; empty when all came.
std::string missingInput(const InputTopics& topics, const InputTotals& now);

/// Whether scans and poses come in, and what becomes of them.
DiagnosticSummary summarizeInputs(const InputTopics& topics, const InputTotals& before,
                                  const InputTotals& now);

/// Whether the map follows its inputs. \param update the newest; null when there is no map.
DiagnosticSummary summarizeMap(const MapUpdate* update, const InputTotals& before,
                               const InputTotals& now);

}  // namespace fiimap
