#include "overwrite.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fiimap {
namespace {

/// Works on the columns of a box that lie side by side along y in one tile.
class RowWriter {
 public:
  RowWriter(const VoxelBox& box, Occupancy state, const LogOdds& log_odds, SlidingGrid* grid,
            ChangeSet* changes)
      : state_(state),
        value_(state == Occupancy::kOccupied ? log_odds.max : log_odds.min),
        grid_(*grid),
        changes_(*changes),
        heights_(grid->layout().words()),
        known_(heights_.size() * kTileSide),
        occupied_(known_.size()) {
    grid->heightMask(box.min.z(), box.max.z(), heights_.data());
  }

  void write(int x, int y, int columns) {
    const int words = columns * grid_.layout().words();
    const std::uint64_t* const known_before = grid_.column(Plane::kKnown, x, y);
    const std::uint64_t* const occupied_before = grid_.column(Plane::kOccupied, x, y);
    for (int w = 0; w < words; ++w) {
      const std::uint64_t mask = maskAt(w);
      const bool is_known = state_ != Occupancy::kUnknown;
      const bool is_occupied = state_ == Occupancy::kOccupied;
      known_[w] = is_known ? known_before[w] | mask : known_before[w] & ~mask;
      occupied_[w] = is_occupied ? occupied_before[w] | mask : occupied_before[w] & ~mask;
      listFlips(x, y, w, occupied_[w] ^ occupied_before[w]);
    }
    if (state_ != Occupancy::kUnknown) writeLogOdds(x, y, words);
    grid_.writeColumns(Plane::kKnown, x, y, columns, known_.data());
    grid_.writeColumns(Plane::kOccupied, x, y, columns, occupied_.data());
    for (int c = 0; c < columns; ++c) grid_.markSeen(x, y + c, 1, heights_.data());
  }

 private:
  /// Bits of the box in a word of the row; a power of two of them are a column.
  std::uint64_t maskAt(int w) const { return heights_[w & (heights_.size() - 1)]; }

  void listFlips(int x, int y, int w, std::uint64_t flipped) {
    auto& list = state_ == Occupancy::kOccupied ? changes_.lower : changes_.raise;
    const int words = grid_.layout().words();
    forEachBit(&flipped, 1, [&](int bit) {
      const int ring_bit = w % words * kWordBits + bit;
      list.emplace_back(x, y + w / words,
                        grid_.layout().heightOf(ring_bit, grid_.window().min.z()));
    });
  }

  void writeLogOdds(int x, int y, int words) {
    std::int8_t* const log_odds = grid_.logOdds(x, y);
    for (int w = 0; w < words; ++w) {
      const std::uint64_t mask = maskAt(w);
      forEachBit(&mask, 1, [&](int bit) { log_odds[w * kWordBits + bit] = value_; });
    }
  }

  Occupancy state_;
  std::int8_t value_;
  SlidingGrid& grid_;
  ChangeSet& changes_;
  std::vector<std::uint64_t> heights_;           // of the box, a column's words
  std::vector<std::uint64_t> known_, occupied_;  // a row's words
};

}  // namespace

void overwrite(const VoxelBox& box, Occupancy state, const LogOdds& log_odds, SlidingGrid* grid,
               ChangeSet* changes) {
  const VoxelBox inside = box.intersection(grid->window());
  if (inside.empty()) return;
  RowWriter writer(inside, state, log_odds, grid, changes);
  for (int x = inside.min.x(); x < inside.max.x(); ++x) {
    for (int y = inside.min.y(); y < inside.max.y();) {
      const int columns = std::min(kTileSide - (y & (kTileSide - 1)), inside.max.y() - y);
      writer.write(x, y, columns);
      y += columns;
    }
  }
}

}  // namespace fiimap
