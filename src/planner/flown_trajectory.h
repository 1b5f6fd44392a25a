#pragma once

#include <algorithm>
#include <memory>

#include "trajectory.h"

namespace fiimap {

/// What a vehicle flies: a trajectory and perhaps the one that takes over at its start time. Cheap
/// to copy; a copy in another thread stays valid.
struct FlownTrajectory {
  std::shared_ptr<const Trajectory> current;  ///< null: nothing is flown
  std::shared_ptr<const Trajectory> next;     ///< null: none

  /// The trajectory that counts at a time. Requires current.
  const Trajectory& at(double time) const {
    return next && time >= next->startTime() ? *next : *current;
  }
  /// The one that is flown in the end.
  const Trajectory& last() const { return next ? *next : *current; }
  bool rests(double time) const { return !next && time >= current->endTime(); }

  /// Drops what is over.
  void advance(double time) {
    if (!next || time < next->startTime()) return;
    current = std::move(next);
    next.reset();
  }
};

}  // namespace fiimap
