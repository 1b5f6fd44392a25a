#include "incremental_inflater.h"

#include <algorithm>

#include "obstacles.h"

namespace fiimap {
namespace {

constexpr int kNotDirty = -1;
static_assert(Strip::kColumns == kTileSide, "a strip is a row of a tile");

/// More obstacles at once are recomputed, not stamped: a stamp takes its time however many others
/// share its columns. With 256 outdoor frames take as long, with 1024 twice.
constexpr std::size_t kMaxStamps = 64;

/// Bits first..last (inclusive) of a tile row.
std::uint32_t rowBits(int first, int last) {
  return (~std::uint32_t{0} << first) & (~std::uint32_t{0} >> (kTileSide - 1 - last));
}

/// Copies every `step`-th word. Compilers vectorize steps that they know.
void copyEvery(int step, const std::uint64_t* __restrict words, int count,
               std::uint64_t* __restrict to) {
  if (step == 1) {
    for (int i = 0; i < count; ++i) to[i] = words[i];
  } else if (step == 2) {
    for (int i = 0; i < count; ++i) to[i] = words[2 * i];
  } else {
    for (int i = 0; i < count; ++i) to[i] = words[step * i];
  }
}

/// The occupied columns of a tile from (x, y) on; null where nothing is occupied because nothing
/// was ever written or the window does not reach there.
const std::uint64_t* occupiedFrom(int x, int y, const SlidingGrid& grid) {
  const VoxelBox& window = grid.window();
  const int low_x = tileFloor(x), low_y = tileFloor(y);
  const bool is_in_reach = low_x < window.max.x() && low_x + kTileSide > window.min.x() &&
                           low_y < window.max.y() && low_y + kTileSide > window.min.y();
  return is_in_reach && grid.isLive(x, y) ? grid.column(Plane::kOccupied, x, y) : nullptr;
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
  dilation.row_step = reach + 1;
  dilation.word_step = (kTileSide + 2 * reach) * dilation.row_step;
  for (int h = reach; h >= 0; --h) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int width = halfWidth(element, dx, h);
      const bool is_wider = width > halfWidth(element, dx, h + 1);
      if (is_wider) dilation.sources.push_back(dx * dilation.row_step + width);
    }
    dilation.sources_end.push_back(static_cast<int>(dilation.sources.size()));
  }
  return dilation;
}

}  // namespace

IncrementalInflater::IncrementalInflater(const StructuringElement& element)
    : kernels_(kernels()),
      reach_(element.reach()),
      stamp_(element),
      dilation_(dilationBy(element)) {
  for (int dx = -reach_; dx <= reach_; ++dx) footprint_.push_back(halfWidth(element, dx, 0));
}

void IncrementalInflater::update(const ChangeSet& changes, SlidingGrid* grid) {
  if (changes.empty()) return;
  const std::vector<VoxelIndex> uncovered = obstaclesBeside(changes.entered, reach_, *grid);
  dirty_slots_.resize(grid->ring().slots(), kNotDirty);
  for (const auto* list : {&changes.lower, &uncovered}) add(*list, grid);
  for (const auto* list : {&changes.raise, &changes.forgotten}) markAround(*list, *grid);
  if (dirty_tiles_.empty()) return;
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
  rows_.resize(static_cast<std::size_t>(words) * kTileSide * readColumns());
  widened_.resize(static_cast<std::size_t>(words) * dilation_.word_step);
  inflated_.resize(static_cast<std::size_t>(words) * kTileSide);
}

void IncrementalInflater::add(const std::vector<VoxelIndex>& obstacles, SlidingGrid* grid) {
  if (obstacles.size() > kMaxStamps) return markAround(obstacles, *grid);
  for (const VoxelIndex& v : obstacles) {
    if (stamp_.fits(v, grid->window())) {  // mostly
      stamp_.apply(v, grid);
    } else {
      markAround(v.x(), v.y(), v.y(), *grid);
    }
  }
}

void IncrementalInflater::markAround(const std::vector<VoxelIndex>& changed,
                                     const SlidingGrid& grid) {
  for (auto v = changed.begin(); v != changed.end();) {
    // Columns of a tile at one x are mostly listed one after the other. Those between them are
    // computed anyway.
    const int x = v->x(), first_y = v->y();
    int last_y = first_y;
    const auto is_near = [&](const VoxelIndex& next) {
      return next.x() == x && next.y() >= last_y && tileFloor(next.y()) == tileFloor(last_y);
    };
    for (; v != changed.end() && is_near(*v); ++v) last_y = v->y();
    markAround(x, first_y, last_y, grid);
  }
}

/// Marks the footprint around the columns (x, first_y) to (x, last_y), tile by tile: mostly one.
void IncrementalInflater::markAround(int x, int first_y, int last_y, const SlidingGrid& grid) {
  const VoxelBox& window = grid.window();
  const int low_x = std::max(x - reach_, window.min.x());
  const int high_x = std::min(x + reach_, window.max.x() - 1);
  const int low_y = std::max(first_y - reach_, window.min.y());
  const int high_y = std::min(last_y + reach_, window.max.y() - 1);
  for (int tile_x = tileFloor(low_x); tile_x <= high_x; tile_x += kTileSide) {
    for (int tile_y = tileFloor(low_y); tile_y <= high_y; tile_y += kTileSide) {
      DirtyTile& tile = dirtyTile(tile_x, tile_y, grid);
      const int first_row = std::max(low_x - tile_x, 0);
      const int last_row = std::min(high_x - tile_x, kTileSide - 1);
      const int low = std::max(low_y - tile_y, 0);
      const int high = std::min(high_y - tile_y, kTileSide - 1);
      for (int row = first_row; row <= last_row; ++row) {
        const int half_width = footprint_[tile_x + row - x + reach_];
        const int first = std::max(first_y - half_width - tile_y, low);
        const int last = std::min(last_y + half_width - tile_y, high);
        if (first <= last) tile.rows[row] |= rowBits(first, last);  // mostly
      }
      tile.marked_rows |= rowBits(first_row, last_row);
    }
  }
}

/// The tile that holds column (x, y); from now on it is among the dirty ones.
IncrementalInflater::DirtyTile& IncrementalInflater::dirtyTile(int x, int y,
                                                               const SlidingGrid& grid) {
  int& index = dirty_slots_[grid.ring().slotOf(x, y)];
  if (index == kNotDirty) {
    index = static_cast<int>(dirty_tiles_.size());
    dirty_tiles_.push_back({{tileFloor(x), tileFloor(y), 0}, 0, {}});
  }
  return dirty_tiles_[index];
}

/// Rows that are so near to each other that they need the same rows around them are computed
/// together.
void IncrementalInflater::recompute(const DirtyTile& tile, SlidingGrid* grid) {
  for (std::uint32_t rest = tile.marked_rows; rest != 0;) {
    const int first_row = __builtin_ctz(rest);
    int last_row = first_row;
    std::uint32_t any_row = 0;
    for (; rest != 0 && __builtin_ctz(rest) - last_row <= 2 * reach_; rest &= rest - 1) {
      last_row = __builtin_ctz(rest);
      any_row |= tile.rows[last_row];
    }
    if (any_row != 0) recompute(tile, {first_row, last_row, spanOf(any_row)}, grid);
  }
}

void IncrementalInflater::recompute(const DirtyTile& tile, const DirtyBlock& block,
                                    SlidingGrid* grid) {
  const int x = tile.origin.x(), y = tile.origin.y();
  const int end = block.last_row + 1 + reach_;
  for (int row = block.first_row - reach_, next; row < end; row = next) {
    next = std::min(end, tileFloor(row) + kTileSide);
    widen(x + row, y, next - row, block.span, *grid, widenedRow(row));
  }
  const int rows = block.last_row + 1 - block.first_row;
  // Columns between dirty ones come out as they were.
  const std::uint32_t* const columns = tile.rows.data() + block.first_row;
  kernels_.dilate(dilation_, widenedRow(block.first_row), columns, rows, inflated_.data());
  grid->replaceRows(Plane::kInflated, x + block.first_row, y, rows, columns, inflated_.data());
}

/// Unions of neighbours in rows of one tile along x.
void IncrementalInflater::widen(int x, int tile_y, int rows, StripSpan span,
                                const SlidingGrid& grid, Strip* widened) {
  const bool needs_one_tile = span.first >= reach_ && span.end + reach_ <= kTileSide;
  const std::uint64_t* const occupied = occupiedFrom(x, tile_y, grid);
  if (dilation_.words == 1 && needs_one_tile && occupied != nullptr) {
    // What kernels load beside these columns and do not need are the tile's other planes.
    kernels_.widen(occupied, kTileSide, rows, span, reach_, widened);
    return;
  }
  read(x, tile_y, rows, span, grid);
  const int row_step = dilation_.words * readColumns();
  for (int w = 0; w < dilation_.words; ++w) {
    kernels_.widen(readRow(0, w), row_step, rows, span, reach_, widened + w * dilation_.word_step);
  }
}

/// Copies what is in and beside rows of a tile, so that nothing that follows has to handle tile
/// borders or window faces: columns outside the window are zero.
void IncrementalInflater::read(int x, int tile_y, int rows, StripSpan span,
                               const SlidingGrid& grid) {
  const int words = dilation_.words;
  const int end = span.end + reach_;
  for (int c = span.first - reach_, next; c < end; c = next) {
    next = std::min(end, tileFloor(c) + kTileSide);
    const std::uint64_t* const columns = occupiedFrom(x, tile_y + c, grid);
    for (int row = 0; row < rows; ++row) {
      for (int w = 0; w < words; ++w) {
        if (columns == nullptr) {
          std::fill_n(readRow(row, w) + c, next - c, 0);
        } else {
          copyEvery(words, columns + row * kTileSide * words + w, next - c, readRow(row, w) + c);
        }
      }
    }
  }
}

}  // namespace fiimap
