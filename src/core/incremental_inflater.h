#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fiimap/inflater.h"
#include "fiimap/kernels.h"

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
/// What is added comes from rows of unions of neighbours along y, which the columns of a tile
/// share: a ball of 10 voxels takes 105 additions instead of 317.
class IncrementalInflater : public Inflater {
 public:
  explicit IncrementalInflater(const StructuringElement& element);

  void update(const ChangeSet& changes, SlidingGrid* grid) override;

 private:
  /// Bit y of row x: the column is dirty.
  struct DirtyTile {
    VoxelIndex origin;
    std::array<std::uint32_t, kTileSide> rows;
  };

  void prepareFor(const SlidingGrid& grid);
  void markAround(const std::vector<VoxelIndex>& changed, const SlidingGrid& grid);
  void markColumns(int x, int y_first, int y_last, const SlidingGrid& grid);
  void recompute(const DirtyTile& tile, SlidingGrid* grid);
  void widenRow(int x, int tile_y, StripSpan span, const SlidingGrid& grid, Strip* widened);
  void readRow(int x, int tile_y, StripSpan span, const SlidingGrid& grid);
  void writeRow(int x, int tile_y, StripSpan span, SlidingGrid* grid);
  Strip* widenedRow(int row);
  std::uint64_t* rowInTile(int w);
  int rowColumns() const { return kTileSide + 2 * reach_; }

  const Kernels& kernels_;
  int reach_;
  std::vector<int> footprint_;  // largest |dy| of the footprint at dx = -reach..reach
  ColumnDilation dilation_;     // by the element

  std::vector<int> dirty_slots_;  // index into dirty_tiles_ by slot of the grid, or -1
  std::vector<DirtyTile> dirty_tiles_;
  std::vector<std::uint64_t> row_;      // by word, occupied columns of one x in and beside a tile
  std::vector<Strip> widened_;          // by word, x and half width
  std::vector<Strip> inflated_;         // by word, of one x
  std::vector<std::uint64_t> columns_;  // inflated, of one x
};

}  // namespace fiimap
