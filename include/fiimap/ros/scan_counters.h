#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fiimap/ros/drop_reason.h"

namespace fiimap {

/// What became of all scans: received == integrated + dropped() + waiting, always.
/// Not thread-safe; copy it to hand it to another thread.
struct ScanCounters {
  std::uint64_t received = 0;    ///< scans that arrived
  std::uint64_t integrated = 0;  ///< scans in the map
  std::uint64_t waiting = 0;     ///< counted where they wait, so that a lost scan shows
  std::array<std::uint64_t, kDropReasonCount> dropped_by_reason{};  ///< indexed by DropReason
  std::uint64_t refused_poses = 0;       ///< pose messages that could not be used; no scans
  std::uint64_t refused_transforms = 0;  ///< of TF, likewise
  /// Poses, transforms and camera infos that gave way to newer ones in the queue.
  std::uint64_t displaced_inputs = 0;
  std::string last_drop;  ///< text of the newest drop; empty when there was none
  /// The scans of each sensor of a map that has several; else empty.
  std::vector<ScanCounters> sensors;

  ///@{
  /// Counts a scan of a sensor (its index; 0 where there is one only).
  void countReceived(std::size_t sensor);
  void countIntegrated(std::size_t sensor);
  void countDrop(const Drop& drop, std::size_t sensor = 0);
  ///@}
  ///@{
  /// Scans that were dropped, for a reason or for any.
  std::uint64_t dropped(DropReason reason) const {
    return dropped_by_reason[static_cast<std::size_t>(reason)];
  }
  std::uint64_t dropped() const;
  ///@}
  /// Whether every scan that was received is accounted for.
  bool conserved() const;

 private:
  ScanCounters* of(std::size_t sensor);
};

}  // namespace fiimap
