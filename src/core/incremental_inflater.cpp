#include "incremental_inflater.h"

#include <algorithm>

#include "obstacles.h"

namespace fiimap {
namespace {

constexpr int kNotDirty = -1;
static_assert(Strip::kColumns == kTileSide, "a strip is a row of a tile");

/// Bits first..last (inclusive) of a tile row.
std::uint32_t rowBits(int first, int last) {
  return (~std::uint32_t{0} << first) & (~std::uint32_t{0} >> (kTileSide - 1 - last));
}

/// From the first set bit to the last one.
StripSpan spanOf(std::uint32_t columns) {
  return {__builtin_ctz(columns), kTileSide - __builtin_clz(columns)};
}

/// Copies every `step`-th word. Compilers vectorize steps that they know.
void copyEvery(int step, const std::uint64_t* words, int count, std::uint64_t* to) {
  if (step == 1) {
    std::copy_n(words, count, to);
  } else if (step == 2) {
    for (int i = 0; i < count; ++i) to[i] = words[2 * i];
  } else {
    for (int i = 0; i < count; ++i) to[i] = words[step * i];
  }
}

/// Largest |dy| at which the element's half height is h or more; -1 where it is lower at all dy.
int halfWidth(const StructuringElement& element, int dx, int h) {
  int width = -1;
  while (element.halfHeight(dx, width + 1) >= h) ++width;
  return width;
}

/// What Horner's scheme has to add. Everything that a half height adds is added by all smaller
/// ones, too, so a row of columns counts only where it is wider than before.
ColumnDilation dilationBy(const StructuringElement& element) {
  const int reach = element.reach();
  ColumnDilation dilation;
  dilation.word_step = (kTileSide + 2 * reach) * (reach + 1);
  for (int h = reach; h >= 0; --h) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int width = halfWidth(element, dx, h);
      const bool is_wider = width > halfWidth(element, dx, h + 1);
      if (is_wider) dilation.sources.push_back(dx * (reach + 1) + width);
    }
    dilation.sources_end.push_back(static_cast<int>(dilation.sources.size()));
  }
  return dilation;
}

}  // namespace

IncrementalInflater::IncrementalInflater(const StructuringElement& element)
    : kernels_(kernels()), reach_(element.reach()), dilation_(dilationBy(element)) {
  for (int dx = -reach_; dx <= reach_; ++dx) footprint_.push_back(halfWidth(element, dx, 0));
}

void IncrementalInflater::update(const ChangeSet& changes, SlidingGrid* grid) {
  if (changes.empty()) return;
  dirty_slots_.resize(grid->ring().slots(), kNotDirty);
  const std::vector<VoxelIndex> uncovered = obstaclesBeside(changes.entered, reach_, *grid);
  for (const auto* list : {&changes.lower, &changes.raise, &changes.forgotten, &uncovered}) {
    markAround(*list, *grid);
  }
  prepareFor(*grid);
  for (const DirtyTile& tile : dirty_tiles_) {
    recompute(tile, grid);
    dirty_slots_[grid->ring().slotOf(tile.origin.x(), tile.origin.y())] = kNotDirty;
  }
  dirty_tiles_.clear();
}

void IncrementalInflater::prepareFor(const SlidingGrid& grid) {
  const int words = grid.layout().words();
  const VoxelBox& window = grid.window();
  dilation_.words = words;
  dilation_.not_top.resize(words);
  dilation_.not_bottom.resize(words);
  grid.heightMask(window.min.z(), window.max.z() - 1, dilation_.not_top.data());
  grid.heightMask(window.min.z() + 1, window.max.z(), dilation_.not_bottom.data());
  row_.resize(static_cast<std::size_t>(words) * rowColumns());
  widened_.resize(static_cast<std::size_t>(words) * dilation_.word_step);
  inflated_.resize(words);
  columns_.resize(static_cast<std::size_t>(words) * kTileSide);
}

void IncrementalInflater::markAround(const std::vector<VoxelIndex>& changed,
                                     const SlidingGrid& grid) {
  const VoxelBox& window = grid.window();
  for (auto v = changed.begin(); v != changed.end();) {
    // Columns near each other along y are mostly listed one after the other. Those between them
    // are dirty, too, or lie between dirty ones and are computed anyway.
    const int x = v->x(), first_y = v->y();
    int last_y = first_y;
    const auto is_near = [&](const VoxelIndex& next) {
      return next.x() == x && next.y() >= last_y && next.y() - last_y <= 2 * reach_ + 1;
    };
    for (; v != changed.end() && is_near(*v); ++v) last_y = v->y();
    const int first_x = std::max(x - reach_, window.min.x());
    const int last_x = std::min(x + reach_, window.max.x() - 1);
    for (int near_x = first_x; near_x <= last_x; ++near_x) {
      const int half_width = footprint_[near_x - x + reach_];
      markColumns(near_x, std::max(first_y - half_width, window.min.y()),
                  std::min(last_y + half_width, window.max.y() - 1), grid);
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
  const VoxelIndex& origin = tile.origin;
  for (int row = first_row - reach_; row <= last_row + reach_; ++row) {
    widenRow(origin.x() + row, origin.y(), spanOf(any_row), *grid, widenedRow(row));
  }
  for (int row = first_row; row <= last_row; ++row) {
    if (tile.rows[row] == 0) continue;
    // Columns between dirty ones come out as they were.
    const StripSpan span = spanOf(tile.rows[row]);
    kernels_.dilate(dilation_, widenedRow(row), span, inflated_.data());
    writeRow(origin.x() + row, origin.y(), span, grid);
  }
}

/// Strips of a row of the tile, or of one up to reach_ beside it.
Strip* IncrementalInflater::widenedRow(int row) {
  return widened_.data() + static_cast<std::ptrdiff_t>(row + reach_) * (reach_ + 1);
}

void IncrementalInflater::widenRow(int x, int tile_y, StripSpan span, const SlidingGrid& grid,
                                   Strip* widened) {
  readRow(x, tile_y, span, grid);
  for (int w = 0; w < dilation_.words; ++w) {
    kernels_.widen(rowInTile(w), span, reach_, widened + w * dilation_.word_step);
  }
}

/// Word w of a row's columns, from the first one of the tile; reach_ columns lie before it.
std::uint64_t* IncrementalInflater::rowInTile(int w) {
  return row_.data() + w * rowColumns() + reach_;
}

/// Copies what is around a part of a tile's row, so that nothing that follows has to handle tile
/// borders or window faces: columns outside the window are zero.
void IncrementalInflater::readRow(int x, int tile_y, StripSpan span, const SlidingGrid& grid) {
  const VoxelBox& window = grid.window();
  const int words = dilation_.words;
  const int first = span.first - reach_, end = span.end + reach_;
  const bool is_inside = x >= window.min.x() && x < window.max.x();
  const int first_inside = is_inside ? std::max(first, window.min.y() - tile_y) : end;
  const int end_inside = is_inside ? std::min(end, window.max.y() - tile_y) : end;
  for (int w = 0; w < words; ++w) {
    std::fill(rowInTile(w) + first, rowInTile(w) + first_inside, 0);
    std::fill(rowInTile(w) + end_inside, rowInTile(w) + end, 0);
  }
  for (int c = first_inside; c < end_inside;) {
    const int next = std::min(end_inside, (c & ~(kTileSide - 1)) + kTileSide);
    const std::uint64_t* const columns = grid.column(Plane::kOccupied, x, tile_y + c);
    for (int w = 0; w < words; ++w) copyEvery(words, columns + w, next - c, rowInTile(w) + c);
    c = next;
  }
}

void IncrementalInflater::writeRow(int x, int tile_y, StripSpan span, SlidingGrid* grid) {
  const int words = dilation_.words;
  const std::uint64_t* columns = inflated_[0].words + span.first;
  if (words > 1) {
    for (int w = 0; w < words; ++w) {
      for (int c = span.first; c < span.end; ++c) {
        columns_[(c - span.first) * words + w] = inflated_[w].words[c];
      }
    }
    columns = columns_.data();
  }
  grid->writeColumns(Plane::kInflated, x, tile_y + span.first, span.end - span.first, columns);
}

}  // namespace fiimap
