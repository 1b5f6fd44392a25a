#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/change_set.h"
#include "fiimap/log_odds.h"
#include "fiimap/scan_mask.h"
#include "fiimap/sliding_grid.h"

namespace fiimap {

/// Applies one scan to the occupancy of the grid (eq. 6-8): one observation per voxel, a hit wins
/// over a miss, log-odds are added once and clamped, and what changed state is reported net.
/// Not thread-safe.
class ScanIntegrator {
 public:
  explicit ScanIntegrator(const LogOdds& log_odds) : log_odds_(log_odds) {}

  /// Updates known, occupied and log-odds from `mask`, whose box must lie in the grid's window.
  /// Appends to changes->lower and changes->raise. The inflated plane is left to the Inflater.
  void apply(const ScanMask& mask, SlidingGrid* grid, ChangeSet* changes);

 private:
  void applyColumn(const ScanMask& mask, int x, int y, SlidingGrid* grid, ChangeSet* changes);

  LogOdds log_odds_;
  std::vector<std::uint64_t> hit_, free_, known_, occupied_;  // one column each, ring layout
};

}  // namespace fiimap
