// Writing columns of the sliding grid. A tile that is shared with a snapshot, or does not exist, is
// compared first: only a change is worth a copy.

#include <algorithm>

#include "fiimap/sliding_grid.h"

namespace fiimap {
namespace {

/// Whether the columns of a row are others than those of the strip.
bool differs(const Strip& words, std::uint32_t columns, const std::uint64_t* row) {
  if (columns == 0) return false;
  const auto [first, end] = spanOf(columns);
  return !std::equal(words.words + first, words.words + end, row + first);
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
  if (layout_.words() > 1) return replaceTallRows(plane, x, y, rows, columns, words);
  Slot* slot = &slots_[ring_.slotOf(x, y)];
  if (!isWritable(*slot)) {
    int row = 0;
    while (row < rows && !differs(words[row], columns[row], column(plane, x + row, y))) ++row;
    if (row == rows) return;
    slot = &liveSlot(x, y);
  }
  std::uint64_t* const target = writableTile(slot) + offsetInTile(plane, x, y, layout_);
  slot->counts[static_cast<int>(plane)] += kernels_.replaceRows(words, columns, rows, target);
}

/// Of columns of several words, which lie side by side.
void SlidingGrid::replaceTallRows(Plane plane, int x, int y, int rows, const std::uint32_t* columns,
                                  const Strip* words) {
  const int step = layout_.words();
  tall_row_.resize(static_cast<std::size_t>(step) * kTileSide);
  for (int i = 0; i < rows; ++i, words += step) {
    if (columns[i] == 0) continue;
    const StripSpan span = spanOf(columns[i]);
    for (int w = 0; w < step; ++w) {
      for (int c = span.first; c < span.end; ++c) tall_row_[c * step + w] = words[w].words[c];
    }
    writeColumns(plane, x + i, y + span.first, span.end - span.first,
                 tall_row_.data() + span.first * step);
  }
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
