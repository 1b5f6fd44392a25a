#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/change_set.h"
#include "fiimap/kernels.h"
#include "fiimap/log_odds.h"
#include "fiimap/scan_mask.h"
#include "fiimap/sliding_grid.h"

namespace fiimap {

/// Applies one scan to the occupancy of the grid (eq. 6-8): one observation per voxel, a hit wins
/// over a miss, log-odds are added once and clamped, and what changed state is reported net.
/// Not thread-safe.
class ScanIntegrator {
 public:
  /// \param log_odds what a hit and a miss add, and the limits.
  explicit ScanIntegrator(const LogOdds& log_odds) : log_odds_(log_odds), kernels_(kernels()) {}

  const LogOdds& logOdds() const { return log_odds_; }  ///< that scans add

  /// Updates known, occupied and log-odds from `mask`, whose box must lie in the grid's window.
  /// Appends to changes->lower and changes->raise. The inflated plane is left to the Inflater.
  void apply(const ScanMask& mask, SlidingGrid* grid, ChangeSet* changes);

  /// Takes over a grid whose log-odds are steps of another scale: each becomes the nearest step of
  /// this one within its limits, and occupied is what reaches this one's threshold. Appends to
  /// changes as apply() does. Passes over all that is known, unless the scales are the same.
  void convert(const LogOdds& from, SlidingGrid* grid, ChangeSet* changes);

 private:
  void applyRow(const ScanMask& mask, int x, int y, int columns, SlidingGrid* grid,
                ChangeSet* changes);
  void convertRow(const std::int8_t* converted, int x, int y, SlidingGrid* grid,
                  ChangeSet* changes);
  void listFlips(int x, int y, const std::uint64_t* occupied_before, int words,
                 const SlidingGrid& grid, ChangeSet* changes) const;

  LogOdds log_odds_;
  const Kernels& kernels_;
  // Columns of one row in a tile, in ring layout.
  std::vector<std::uint64_t> hit_, free_, known_, occupied_;
};

}  // namespace fiimap
