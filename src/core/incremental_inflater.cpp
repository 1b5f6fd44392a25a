#include "incremental_inflater.h"

#include <algorithm>

#include "obstacles.h"

namespace fiimap {
namespace {

constexpr int kNotDirty = -1;

/// Bits first..last (inclusive) of a tile row.
std::uint32_t rowBits(int first, int last) {
  return (~std::uint32_t{0} << first) & (~std::uint32_t{0} >> (kTileSide - 1 - last));
}

}  // namespace

IncrementalInflater::IncrementalInflater(const StructuringElement& element)
    : reach_(element.reach()), runs_by_half_height_(element.reach() + 1) {
  for (int dx = -reach_; dx <= reach_; ++dx) {
    int widest = 0;
    for (int dy = -reach_; dy <= reach_; ++dy) {
      const int half_height = element.halfHeight(dx, dy);
      if (half_height < 0) continue;
      widest = std::max(widest, dy);
      std::vector<Run>& runs = runs_by_half_height_[half_height];
      const bool continues = !runs.empty() && runs.back().dx == dx && runs.back().dy_last == dy - 1;
      if (continues) {
        runs.back().dy_last = dy;
      } else {
        runs.push_back({dx, dy, dy});
      }
    }
    footprint_.push_back(widest);
  }
}

void IncrementalInflater::update(const ChangeSet& changes, SlidingGrid* grid) {
  if (changes.empty()) return;
  words_ = grid->layout().words();
  dirty_slots_.resize(grid->ring().slots(), kNotDirty);
  const std::vector<VoxelIndex> uncovered = obstaclesBeside(changes.entered, reach_, *grid);
  for (const auto* list : {&changes.lower, &changes.raise, &changes.forgotten, &uncovered}) {
    markAround(*list, *grid);
  }

  const VoxelBox& window = grid->window();
  not_top_.resize(words_);
  not_bottom_.resize(words_);
  grid->heightMask(window.min.z(), window.max.z() - 1, not_top_.data());
  grid->heightMask(window.min.z() + 1, window.max.z(), not_bottom_.data());
  for (const DirtyTile& tile : dirty_tiles_) {
    recompute(tile, grid);
    dirty_slots_[grid->ring().slotOf(tile.origin.x(), tile.origin.y())] = kNotDirty;
  }
  dirty_tiles_.clear();
}

void IncrementalInflater::markAround(const std::vector<VoxelIndex>& changed,
                                     const SlidingGrid& grid) {
  const VoxelBox& window = grid.window();
  const VoxelIndex* last = nullptr;
  for (const VoxelIndex& v : changed) {
    // Voxels of one column are listed one after the other.
    if (last != nullptr && last->x() == v.x() && last->y() == v.y()) continue;
    last = &v;
    const int first_x = std::max(v.x() - reach_, window.min.x());
    const int last_x = std::min(v.x() + reach_, window.max.x() - 1);
    for (int x = first_x; x <= last_x; ++x) {
      const int half_width = footprint_[x - v.x() + reach_];
      markColumns(x, std::max(v.y() - half_width, window.min.y()),
                  std::min(v.y() + half_width, window.max.y() - 1), grid);
    }
  }
}

void IncrementalInflater::markColumns(int x, int y_first, int y_last, const SlidingGrid& grid) {
  for (int y = y_first; y <= y_last;) {
    const int tile_y = y & ~(kTileSide - 1);
    const int last = std::min(y_last, tile_y + kTileSide - 1);
    int& index = dirty_slots_[grid.ring().slotOf(x, y)];
    if (index == kNotDirty) {
      index = static_cast<int>(dirty_tiles_.size());
      dirty_tiles_.push_back({{x & ~(kTileSide - 1), tile_y, 0}, {}});
    }
    dirty_tiles_[index].rows[x & (kTileSide - 1)] |= rowBits(y - tile_y, last - tile_y);
    y = last + 1;
  }
}

void IncrementalInflater::recompute(const DirtyTile& tile, SlidingGrid* grid) {
  std::uint32_t any_row = 0;
  int first_row = kTileSide, last_row = -1;
  for (int row = 0; row < kTileSide; ++row) {
    if (tile.rows[row] == 0) continue;
    any_row |= tile.rows[row];
    first_row = std::min(first_row, row);
    last_row = row;
  }
  const int y_first = tile.origin.y() + __builtin_ctz(any_row);
  const int y_last = tile.origin.y() + kTileSide - 1 - __builtin_clz(any_row);
  gather({{tile.origin.x() + first_row - reach_, y_first - reach_, 0},
          {tile.origin.x() + last_row + reach_ + 1, y_last + reach_ + 1, 1}},
         *grid);

  for (int row = first_row; row <= last_row; ++row) {
    const std::uint64_t bits = tile.rows[row];
    forEachRun(&bits, 1, [&](int first, int last) {
      recomputeRow(tile.origin.x() + row, tile.origin.y() + first, tile.origin.y() + last, grid);
    });
  }
}

/// Copies occupied columns side by side, so that the inner loop runs over plain arrays and no tile
/// border or window face has to be handled in it: columns outside the window are zero.
void IncrementalInflater::gather(const VoxelBox& columns, const SlidingGrid& grid) {
  gathered_ = columns;
  const int side_y = columns.size().y();
  occupied_.resize(static_cast<std::size_t>(columns.size().x()) * side_y * words_);
  const VoxelBox inside = columns.intersection(grid.window());
  for (int x = columns.min.x(); x < columns.max.x(); ++x) {
    std::uint64_t* const row = occupied_.data() + gatheredOffset(x, columns.min.y());
    const bool is_inside = x >= inside.min.x() && x < inside.max.x();
    const int first_y = is_inside ? inside.min.y() : columns.max.y();
    const int end_y = is_inside ? inside.max.y() : columns.max.y();
    std::fill(row, occupied_.data() + gatheredOffset(x, first_y), 0);
    for (int y = first_y; y < end_y;) {
      const int end_of_tile = (y & ~(kTileSide - 1)) + kTileSide;
      const int count = std::min(end_y, end_of_tile) - y;
      std::copy_n(grid.column(Plane::kOccupied, x, y), count * words_,
                  occupied_.data() + gatheredOffset(x, y));
      y += count;
    }
    std::fill(occupied_.data() + gatheredOffset(x, end_y), row + side_y * words_, 0);
  }
}

/// Where a column begins in occupied_.
std::size_t IncrementalInflater::gatheredOffset(int x, int y) const {
  const std::size_t row = x - gathered_.min.x();
  return (row * gathered_.size().y() + y - gathered_.min.y()) * words_;
}

void IncrementalInflater::recomputeRow(int x, int y_first, int y_last, SlidingGrid* grid) {
  const int count = (y_last - y_first + 1) * words_;
  inflated_.assign(count, 0);
  for (int half_height = reach_; half_height >= 0; --half_height) {
    for (const Run& run : runs_by_half_height_[half_height]) {
      for (int dy = run.dy_first; dy <= run.dy_last; ++dy) {
        const std::uint64_t* source = occupied_.data() + gatheredOffset(x + run.dx, y_first + dy);
        for (int i = 0; i < count; ++i) inflated_[i] |= source[i];
      }
    }
    if (half_height == 0) break;
    dilateAlongZ(y_last - y_first + 1, inflated_.data());
  }
  grid->writeColumns(Plane::kInflated, x, y_first, y_last - y_first + 1, inflated_.data());
}

/// Dilates columns by one voxel up and down. Bits that would leave the window are taken away
/// before the shift, because in the ring they would come back at its other end.
void IncrementalInflater::dilateAlongZ(int columns, std::uint64_t* words) const {
  constexpr int kCarry = kWordBits - 1;
  if (words_ == 1) {
    const std::uint64_t not_top = not_top_[0], not_bottom = not_bottom_[0];
    for (int c = 0; c < columns; ++c) {
      const std::uint64_t up = words[c] & not_top;
      const std::uint64_t down = words[c] & not_bottom;
      words[c] |= (up << 1) | (up >> kCarry) | (down >> 1) | (down << kCarry);
    }
    return;
  }
  for (std::uint64_t* column = words; column < words + columns * words_; column += words_) {
    const int last = words_ - 1;
    const std::uint64_t first_word = column[0];
    std::uint64_t below = column[last];
    for (int w = 0; w < words_; ++w) {
      const std::uint64_t word = column[w];
      const int below_index = w == 0 ? last : w - 1;
      const int above_index = w == last ? 0 : w + 1;
      const std::uint64_t above = w == last ? first_word : column[w + 1];
      column[w] |= ((word & not_top_[w]) << 1) | ((below & not_top_[below_index]) >> kCarry) |
                   ((word & not_bottom_[w]) >> 1) | ((above & not_bottom_[above_index]) << kCarry);
      below = word;
    }
  }
}

}  // namespace fiimap
