#include "fiimap/ros/scan_counters.h"

#include <numeric>

namespace fiimap {

void ScanCounters::countDrop(const Drop& drop) {
  ++dropped_by_reason[static_cast<std::size_t>(drop.reason)];
  last_drop = drop.text();
}

std::uint64_t ScanCounters::dropped() const {
  return std::accumulate(dropped_by_reason.begin(), dropped_by_reason.end(), std::uint64_t{0});
}

}  // namespace fiimap
