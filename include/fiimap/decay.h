#pragma once

#include <cstdint>
#include <optional>

#include "fiimap/change_set.h"
#include "fiimap/sliding_grid.h"

namespace fiimap {

/// Forgets what scans have not seen for a while: things that moved on, traces of drift. A voxel
/// that no scan hit or passed becomes unknown, never free, when between one and two decay times
/// have gone by; tiles are visited in turn, each once in a decay time, so that a scan visits few.
/// Time is that of the scans' stamps, and a gap between two scans counts as one decay time at most:
/// a sensor that fell silent says nothing about the world. The scan after such a gap visits all
/// tiles. Not in the paper. Not thread-safe.
class Decay {
 public:
  /// \param time s; 0: nothing is forgotten.
  explicit Decay(double time) { setTime(time); }

  /// Begins a round of visits with another time, s.
  void setTime(double time);
  /// Takes a grid's visits up to the time of a scan that was applied to it. Scans that are older
  /// than the newest do nothing. Appends obstacles that are forgotten to changes->raise.
  void advance(std::int64_t stamp_ns, SlidingGrid* grid, ChangeSet* changes);
  /// Stamps may begin again.
  void restart();

 private:
  int visitsUntil(std::int64_t elapsed_ns, int slots) const;

  std::int64_t time_ns_ = 0;
  std::optional<std::int64_t> newest_ns_;
  std::int64_t elapsed_ns_ = 0;  // of this round of visits, less than time_ns_
  int visited_ = 0;              // slots in this round
};

}  // namespace fiimap
