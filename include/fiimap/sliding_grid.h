#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiimap/bit_column.h"
#include "fiimap/change_set.h"
#include "fiimap/kernels.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Bit layers of the grid: one bit per voxel each.
enum class Plane { kKnown, kOccupied, kInflated };
/// Number of planes.
constexpr int kPlaneCount = 3;

///@{
/// Columns are grouped into square tiles of this many columns a side; the shift divides by them.
constexpr int kTileShift = 5;
constexpr int kTileSide = 1 << kTileShift;
constexpr int kTileColumns = kTileSide * kTileSide;
///@}

/// Where the bits of a voxel column are: a ring of 64-bit words, a power of two of them, in which
/// the voxel at height z has the bit z mod (64 words), whatever the window. So nothing moves when
/// the window slides, and addressing is a mask instead of a slow modulo.
class ColumnLayout {
 public:
  /// \param height largest number of voxels that a column has to hold at once, >= 1.
  explicit ColumnLayout(int height) : words_(1) {
    while (bits() < height) words_ *= 2;
  }

  /// Words of a column.
  int words() const { return words_; }
  /// Voxels that a column has room for, >= its height.
  int bits() const { return words_ * kWordBits; }
  /// Bit of height z within the column.
  int bitOf(int z) const { return z & (bits() - 1); }
  /// Height of a bit, given the lowest height that the column holds now.
  int heightOf(int bit, int min_z) const { return min_z + bitOf(bit - min_z); }

 private:
  int words_;
};

/// Lowest coordinate of the tile that holds this one.
inline int tileFloor(int coordinate) { return coordinate & ~(kTileSide - 1); }
/// Index of column (x, y) within its tile.
inline int columnInTile(int x, int y) {
  return ((x & (kTileSide - 1)) << kTileShift) | (y & (kTileSide - 1));
}

/// The bit planes of 32 x 32 voxel columns: tileWords() words. Within a plane, columns are
/// row-major (x, then y) and each column has ColumnLayout::words() words. Tiles are shared with
/// snapshots and copied before the first change after one (copy on write).
using Tile = std::uint64_t[];

/// Words of one plane of a tile.
inline std::size_t planeWords(const ColumnLayout& layout) {
  return static_cast<std::size_t>(kTileColumns) * layout.words();
}
/// Words of a tile, all planes.
inline std::size_t tileWords(const ColumnLayout& layout) {
  return kPlaneCount * planeWords(layout);
}
/// Where the words of a column begin within its tile.
inline std::size_t offsetInTile(Plane plane, int x, int y, const ColumnLayout& layout) {
  return (static_cast<std::size_t>(plane) * kTileColumns + columnInTile(x, y)) * layout.words();
}

/// Tiles by position: a power-of-two ring on x and y, large enough that no two tiles of a window
/// share a slot, so that addressing is a shift and a mask (eq. 2, wrapped circularly).
class TileRing {
 public:
  /// \param columns_x, columns_y window size, voxels.
  TileRing(int columns_x, int columns_y);

  /// Largest number of tiles that a window touches along an axis: one that starts in the middle of
  /// a tile touches one tile more than its size suggests.
  static int tilesAcross(int columns) { return (columns + kTileSide - 2) / kTileSide + 1; }

  /// Number of slots, a power of two.
  int slots() const { return (mask_x_ + 1) * (mask_y_ + 1); }
  /// Slot of the tile that holds column (x, y).
  int slotOf(int x, int y) const {
    return ((x >> kTileShift) & mask_x_) * (mask_y_ + 1) + ((y >> kTileShift) & mask_y_);
  }

 private:
  int mask_x_;
  int mask_y_;
};

/// The sliding occupancy grid (Section 3.1): three bit planes and the log-odds of every voxel of a
/// window that follows the vehicle. Voxels keep their place in memory when the window slides; what
/// leaves is forgotten, what enters is unknown. Memory is taken tile by tile where something has
/// been seen; that of the log-odds is kept for reuse.
///
/// Invariant: bits of voxels outside the window are zero in every plane.
/// Not thread-safe: one thread owns the grid; other threads read snapshots.
class SlidingGrid {
 public:
  /// \param size window size in voxels, each >= 1.
  explicit SlidingGrid(const VoxelIndex& size);

  /// Voxels that the grid covers.
  const VoxelBox& window() const { return window_; }
  /// Where a column's bits are.
  const ColumnLayout& layout() const { return layout_; }
  /// Where a column's tile is.
  const TileRing& ring() const { return ring_; }

  /// Moves the window so that its lowest corner is `min`. Voxels left behind are forgotten. Appends
  /// to changes->forgotten and changes->entered. The inflated plane keeps its bits inside the
  /// window and is exact again after the next Inflater::update with these changes.
  void moveTo(const VoxelIndex& min, ChangeSet* changes);
  /// Forgets everything; the window stays.
  void clear();
  /// Clears one plane in the whole window.
  void clearPlane(Plane plane);

  /// One bit. False for voxels outside the window.
  bool test(Plane plane, const VoxelIndex& v) const;
  /// Sets one bit. Voxels outside the window are ignored.
  void set(Plane plane, const VoxelIndex& v, bool value);

  /// Whether something was ever written in the tile of column (x, y).
  bool isLive(int x, int y) const { return slots_[ring_.slotOf(x, y)].tile != nullptr; }
  /// Words of a column, layout().words() of them; those of the columns after it along y follow, to
  /// the end of its tile. All zero where nothing was ever written.
  const std::uint64_t* column(Plane plane, int x, int y) const {
    const std::uint64_t* const tile = slots_[ring_.slotOf(x, y)].tile.get();
    return tile == nullptr ? zero_row_.data() : tile + offsetInTile(plane, x, y, layout_);
  }
  /// Replaces a column's words. Writing what is there already costs no copy.
  /// \param words bits outside the window must be zero.
  void writeColumn(Plane plane, int x, int y, const std::uint64_t* words) {
    writeColumns(plane, x, y, 1, words);
  }
  /// The same for the columns (x, y), (x, y + 1), ..., which must lie in one tile.
  void writeColumns(Plane plane, int x, int y, int columns, const std::uint64_t* words);
  /// Replaces columns of one tile, in `rows` rows along x from that of (x, y) on, where y is the
  /// tile's lowest. Writing what is there already costs no copy.
  /// \param columns bits of those in each row; those between are replaced, too.
  /// \param words one strip per word for each row; bits outside the window must be zero.
  void replaceRows(Plane plane, int x, int y, int rows, const std::uint32_t* columns,
                   const Strip* words);
  /// Sets bits of columns of one tile, `columns` of them from (x, y) on in each of `rows` rows
  /// along x. Setting what is set already costs no copy. \param columns a multiple of
  /// Strip::kGroup. \param words of the first row; those of the next one are `row_step` words
  /// later. Bits outside the window must be zero.
  void addToColumns(Plane plane, int x, int y, int rows, int columns, const std::uint64_t* words,
                    int row_step);
  /// Log-odds of a column, one byte per bit of the ring; meaningful where the voxel is known.
  /// Allocates; the pointer holds until the window moves.
  std::int8_t* logOdds(int x, int y);

  ///@{
  /// Which voxels were seen of late, for Decay; kept only on demand, and not in the tiles, because
  /// snapshots have no use for it.

  /// Whether it is kept from now on. All that is known counts as seen now.
  void keepSeen(bool keep);
  /// Marks voxels of the columns (x, y), (x, y + 1), ..., which must lie in one tile, as seen.
  /// Nothing happens where nothing is known.
  /// \param voxels of `columns` columns in ring layout.
  void markSeen(int x, int y, int columns, const std::uint64_t* voxels);
  /// Makes the voxels of a slot's tile unknown that were not marked since the last such call for
  /// this slot, and appends those that were occupied. A tile in which nothing is left is given up.
  void forgetUnseen(int slot, std::vector<VoxelIndex>* obstacles);
  ///@}

  /// Ring mask of the heights of [min_z, max_z) that lie in the window, layout().words() words.
  void heightMask(int min_z, int max_z, std::uint64_t* words) const;

  /// Tiles in which something was written, by slot.
  const std::vector<int>& liveSlots() const { return live_; }
  /// Lowest column of the tile in a live slot (x, y; z is 0).
  const VoxelIndex& tileOrigin(int slot) const { return slots_[slot].origin; }
  /// Calls visit(VoxelIndex), which must not change the grid, for every set voxel of a plane in a
  /// box, tile by tile.
  template <typename Visitor>
  void forEach(Plane plane, const VoxelBox& box, Visitor&& visit) const;

  /// Shares the tiles as they are now, by slot (null where nothing was written). Later changes of
  /// the grid do not show in them.
  std::vector<std::shared_ptr<const Tile>> shareTiles();

  /// Number of set voxels of a plane.
  std::int64_t count(Plane plane) const;
  /// Memory held now, bytes.
  std::size_t memoryBytes() const;
  /// Memory held when every voxel of the window has been seen, bytes.
  std::size_t worstCaseMemoryBytes() const { return worstCaseMemoryBytes(size_, keeps_seen_); }
  /// The same of a grid with a window of this size, voxels.
  static std::size_t worstCaseMemoryBytes(const VoxelIndex& size, bool keeps_seen);

 private:
  struct Slot {
    std::shared_ptr<Tile> tile;
    /// Number of shareTiles() calls when this copy of the tile was made: one of an older number may
    /// be in a snapshot and must not change.
    std::uint64_t generation = 0;
    std::unique_ptr<std::int8_t[]> log_odds;
    /// As a plane of the tile; null unless it is kept. Bits of unknown voxels mean nothing.
    std::unique_ptr<std::uint64_t[]> seen;
    VoxelIndex origin = VoxelIndex::Zero();
    std::size_t live_position = 0;
    std::int32_t counts[kPlaneCount] = {0, 0, 0};  ///< set voxels of each plane
  };

  void replaceTallRows(Plane plane, int x, int y, int rows, const std::uint32_t* columns,
                       const Strip* words);
  Slot& liveSlot(int x, int y);
  bool isWritable(const Slot& slot) const {
    return slot.tile != nullptr && slot.generation == generation_;
  }
  std::uint64_t* writableTile(Slot* slot);
  void drop(int slot);
  void forgetTile(int slot, std::vector<VoxelIndex>* forgotten);
  void forgetOutside(const VoxelBox& kept, int slot, std::vector<VoxelIndex>* forgotten);
  void forgetRow(Plane plane, int x, const std::uint64_t* kept, Slot* slot,
                 std::vector<VoxelIndex>* forgotten);
  void listObstacles(std::uint64_t word, int w, int x, int y,
                     std::vector<VoxelIndex>* obstacles) const;
  std::size_t tileBytes() const { return tileBytes(layout_, keeps_seen_); }
  std::size_t logOddsBytes() const { return logOddsBytes(layout_); }
  static std::size_t tileBytes(const ColumnLayout& layout, bool keeps_seen);
  static std::size_t logOddsBytes(const ColumnLayout& layout);

  VoxelIndex size_;
  VoxelBox window_;
  ColumnLayout layout_;
  TileRing ring_;
  const Kernels& kernels_;
  bool keeps_seen_ = false;
  std::vector<Slot> slots_;
  std::vector<int> live_;
  std::vector<std::unique_ptr<std::int8_t[]>> spare_log_odds_;
  std::vector<std::uint64_t> zero_row_;  // of the columns of a tile at one x
  std::vector<std::uint64_t> tall_row_;  // scratch
  std::uint64_t generation_ = 0;
};

template <typename Visitor>
void SlidingGrid::forEach(Plane plane, const VoxelBox& box, Visitor&& visit) const {
  const VoxelBox inside = box.intersection(window_);
  if (inside.empty()) return;
  const int words = layout_.words();
  std::vector<std::uint64_t> heights(words);
  heightMask(inside.min.z(), inside.max.z(), heights.data());
  for (const int slot : live_) {
    if (slots_[slot].counts[static_cast<int>(plane)] == 0) continue;
    const VoxelIndex first = tileOrigin(slot).cwiseMax(inside.min);
    const VoxelIndex end = (tileOrigin(slot).array() + kTileSide).matrix().cwiseMin(inside.max);
    const int row_words = (end.y() - first.y()) * words;
    for (int x = first.x(); x < end.x(); ++x) {
      const std::uint64_t* const row = column(plane, x, first.y());
      for (int w = 0; w < row_words; ++w) {
        const int w_in_column = w & (words - 1);
        const std::uint64_t found = row[w] & heights[w_in_column];
        if (found == 0) continue;  // mostly
        forEachBit(&found, 1, [&](int bit) {
          const int ring_bit = w_in_column * kWordBits + bit;
          visit(VoxelIndex(x, first.y() + w / words, layout_.heightOf(ring_bit, window_.min.z())));
        });
      }
    }
  }
}

}  // namespace fiimap
