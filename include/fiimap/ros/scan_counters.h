#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "fiimap/ros/drop_reason.h"

namespace fiimap {

/// What became of all scans. received == integrated + dropped() + those that wait somewhere.
/// Not thread-safe; copy it to hand it to another thread.
struct ScanCounters {
  std::uint64_t received = 0;
  std::uint64_t integrated = 0;
  std::array<std::uint64_t, kDropReasonCount> dropped_by_reason{};
  std::string last_drop;  ///< text of the newest drop; empty when there was none

  void countDrop(const Drop& drop);
  std::uint64_t dropped(DropReason reason) const {
    return dropped_by_reason[static_cast<std::size_t>(reason)];
  }
  std::uint64_t dropped() const;
  /// Scans that are neither integrated nor dropped yet.
  std::uint64_t waiting() const { return received - integrated - dropped(); }
};

}  // namespace fiimap
