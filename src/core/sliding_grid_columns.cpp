// Writing columns of the sliding grid. A tile that is shared with a snapshot, or does not exist, is
// compared first: only a change is worth a copy.

#include <algorithm>

#include "fiimap/sliding_grid.h"

namespace fiimap {
namespace {

/// Whether the columns of a row are others than those of the strips.
bool differs(const Strip* words, std::uint32_t columns, int words_per_column,
             const std::uint64_t* row) {
  if (columns == 0) return false;
  const StripSpan span = spanOf(columns);
  for (int c = span.first; c < span.end; ++c) {
    for (int w = 0; w < words_per_column; ++w) {
      if (row[c * words_per_column + w] != words[w].words[c]) return true;
    }
  }
  return false;
}

}  // namespace

void SlidingGrid::writeColumns(Plane plane, int x, int y, int columns, const std::uint64_t* words) {
  const int count = columns * layout_.words();
  Slot* slot = &slots_[ring_.slotOf(x, y)];
  if (!isWritable(*slot)) {
    if (std::equal(words, words + count, column(plane, x, y))) return;
    slot = &liveSlot(x, y);
  }
  std::uint64_t* const target = writableTile(slot) + offsetInTile(plane, x, y, layout_);
  slot->counts[static_cast<int>(plane)] += kernels_.replace(words, count, target);
}

void SlidingGrid::replaceRows(Plane plane, int x, int y, int rows, const std::uint32_t* columns,
                              const Strip* words) {
  Slot* slot = &slots_[ring_.slotOf(x, y)];
  if (!isWritable(*slot)) {
    bool changes_something = false;
    for (int i = 0; i < rows; ++i) {
      changes_something = changes_something || differs(words + i * layout_.words(), columns[i],
                                                       layout_.words(), column(plane, x + i, y));
    }
    if (!changes_something) return;
    slot = &liveSlot(x, y);
  }
  std::uint64_t* const target = writableTile(slot) + offsetInTile(plane, x, y, layout_);
  slot->counts[static_cast<int>(plane)] +=
      kernels_.replaceRows(words, columns, rows, layout_.words(), target);
}

void SlidingGrid::addToColumns(Plane plane, int x, int y, int rows, int columns,
                               const std::uint64_t* words, int row_step) {
  const int count = columns * layout_.words();
  Slot* slot = &slots_[ring_.slotOf(x, y)];
  if (!isWritable(*slot)) {
    std::uint64_t added = 0;
    for (int i = 0; i < rows; ++i) {
      const std::uint64_t* const row = column(plane, x + i, y);
      for (int w = 0; w < count; ++w) added |= words[i * row_step + w] & ~row[w];
    }
    if (added == 0) return;
    slot = &liveSlot(x, y);
  }
  std::uint64_t* const target = writableTile(slot) + offsetInTile(plane, x, y, layout_);
  slot->counts[static_cast<int>(plane)] +=
      kernels_.add(words, row_step, rows, count, target, kTileSide * layout_.words());
}

}  // namespace fiimap
