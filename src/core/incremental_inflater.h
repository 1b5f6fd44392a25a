#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fiimap/inflater.h"

namespace fiimap {

/// Inflation by dirty columns of bit planes, the default.
///
/// A changed obstacle can only change the inflated columns within the element's footprint around
/// it: these are marked dirty, once however many changes share them, and each is computed anew as a
/// whole. Raised and lowered voxels are treated alike, so there is no order to keep and nothing to
/// restore, and the cost can never exceed one recomputation of the columns near changes.
///
/// An inflated column is the union of its neighbours' occupied columns, each dilated along z by the
/// element's half height there. Sorted by half height h this is Horner's scheme: take the columns
/// of the largest h, dilate by one, add those of h - 1, dilate by one, and so on down to h = 0.
class IncrementalInflater : public Inflater {
 public:
  explicit IncrementalInflater(const StructuringElement& element);

  void update(const ChangeSet& changes, SlidingGrid* grid) override;

 private:
  /// A run of neighbouring columns at one dx whose half height is the same.
  struct Run {
    int dx, dy_first, dy_last;
  };
  /// Bit y of row x: the column is dirty.
  struct DirtyTile {
    VoxelIndex origin;
    std::array<std::uint32_t, kTileSide> rows;
  };

  void markAround(const std::vector<VoxelIndex>& changed, const SlidingGrid& grid);
  void markColumns(int x, int y_first, int y_last, const SlidingGrid& grid);
  void recompute(const DirtyTile& tile, SlidingGrid* grid);
  void gather(const VoxelBox& columns, const SlidingGrid& grid);
  void recomputeRow(int x, int y_first, int y_last, SlidingGrid* grid);
  std::size_t gatheredOffset(int x, int y) const;
  void dilateAlongZ(int columns, std::uint64_t* words) const;

  int reach_;
  std::vector<std::vector<Run>> runs_by_half_height_;
  std::vector<int> footprint_;  // largest |dy| of the footprint at dx = -reach..reach

  std::vector<int> dirty_slots_;  // index into dirty_tiles_ by slot of the grid, or -1
  std::vector<DirtyTile> dirty_tiles_;
  std::vector<std::uint64_t> not_top_, not_bottom_;  // ring masks: all but the window's top, bottom
  VoxelBox gathered_;                                // columns in occupied_
  std::vector<std::uint64_t> occupied_;
  std::vector<std::uint64_t> inflated_;  // columns of one row
  int words_ = 1;
};

}  // namespace fiimap
