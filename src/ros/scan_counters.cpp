#include "fiimap/ros/scan_counters.h"

#include <algorithm>
#include <numeric>

namespace fiimap {

/// Null where there is one sensor only.
ScanCounters* ScanCounters::of(std::size_t sensor) {
  return sensors.empty() ? nullptr : &sensors.at(sensor);
}

void ScanCounters::countReceived(std::size_t sensor) {
  ++received;
  if (ScanCounters* const own = of(sensor)) ++own->received;
}

void ScanCounters::countIntegrated(std::size_t sensor) {
  ++integrated;
  if (ScanCounters* const own = of(sensor)) ++own->integrated;
}

void ScanCounters::countDrop(const Drop& drop, std::size_t sensor) {
  ++dropped_by_reason[static_cast<std::size_t>(drop.reason)];
  last_drop = drop.text();
  if (ScanCounters* const own = of(sensor)) own->countDrop(drop);
}

std::uint64_t ScanCounters::dropped() const {
  return std::accumulate(dropped_by_reason.begin(), dropped_by_reason.end(), std::uint64_t{0});
}

bool ScanCounters::conserved() const {
  const auto add = [](std::uint64_t sum, const ScanCounters& own) { return sum + own.received; };
  const bool complete = sensors.empty() || std::accumulate(sensors.begin(), sensors.end(),
                                                           std::uint64_t{0}, add) == received;
  return complete && received == integrated + dropped() + waiting &&
         std::all_of(sensors.begin(), sensors.end(),
                     [](const ScanCounters& own) { return own.conserved(); });
}

}  // namespace fiimap
