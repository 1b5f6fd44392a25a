#pragma once

// Dilation of bit columns, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

/// Whole groups, so that compilers' vectors fit.
inline StripSpan wholeGroups(const StripSpan& span) {
  return {span.first / kGroup * kGroup, (span.end + kGroup - 1) / kGroup * kGroup};
}

inline void widenRow(const std::uint64_t* row, StripSpan span, int reach, Strip* widened) {
  const auto [first, end] = wholeGroups(span);
  for (int c = first; c < end; ++c) widened->words[c] = row[c];
  for (int k = 1; k <= reach; ++k) {
    const std::uint64_t* const narrower = widened[k - 1].words;
    std::uint64_t* const wider = widened[k].words;
    for (int c = first; c < end; ++c) wider[c] = narrower[c] | row[c - k] | row[c + k];
  }
}

inline void widen(const std::uint64_t* row, int row_step, int rows, StripSpan span, int reach,
                  Strip* widened) {
  for (int i = 0; i < rows; ++i) {
    widenRow(row + i * row_step, span, reach, widened + i * (reach + 1));
  }
}

/// One voxel up and down.
inline void dilateAlongZ(const ColumnDilation& dilation, int first, int end, Strip* dilated) {
  constexpr int kCarry = kWordBits - 1;
  const int last = dilation.words - 1;
  Strip up_below, lowest;
  for (int c = first; c < end; ++c) {
    up_below.words[c] = dilated[last].words[c] & dilation.not_top[last];
    lowest.words[c] = dilated[0].words[c];
  }
  for (int w = 0; w <= last; ++w) {
    const std::uint64_t not_top = dilation.not_top[w];
    const std::uint64_t not_bottom = dilation.not_bottom[w];
    const std::uint64_t not_bottom_above = dilation.not_bottom[w < last ? w + 1 : 0];
    const Strip& above = w < last ? dilated[w + 1] : lowest;
    for (int c = first; c < end; ++c) {
      const std::uint64_t word = dilated[w].words[c];
      const std::uint64_t up = word & not_top;
      const std::uint64_t down_above = above.words[c] & not_bottom_above;
      dilated[w].words[c] = word | (up << 1) | (up_below.words[c] >> kCarry) |
                            ((word & not_bottom) >> 1) | (down_above << kCarry);
      up_below.words[c] = up;
    }
  }
}

/// Adds the strips that are `sources` away to a group of columns. It stays in registers: with 10
/// voxels of inflation three quarters of the time of a loop over the whole span.
inline void addSources(const Strip* source, const std::int32_t* sources, int count, int column,
                       std::uint64_t* sum) {
  std::uint64_t all[kGroup];
  std::memcpy(all, sum, sizeof(all));
  for (int s = 0; s < count; ++s) {
    const std::uint64_t* const words = source[sources[s]].words + column;
    for (int i = 0; i < kGroup; ++i) all[i] |= words[i];
  }
  std::memcpy(sum, all, sizeof(all));
}

inline void dilateRow(const ColumnDilation& dilation, const Strip* source, StripSpan span,
                      Strip* dilated) {
  const auto [first, end] = wholeGroups(span);
  for (int w = 0; w < dilation.words; ++w)
    std::fill(dilated[w].words + first, dilated[w].words + end, 0);
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) dilateAlongZ(dilation, first, end, dilated);
    for (int w = 0; w < dilation.words; ++w) {
      for (int c = first; c < end; c += kGroup) {
        addSources(source + w * dilation.word_step, dilation.sources.data() + s, sources_end - s, c,
                   dilated[w].words + c);
      }
    }
    s = sources_end;
  }
}

inline void dilate(const ColumnDilation& dilation, const Strip* source,
                   const std::uint32_t* columns, int rows, Strip* dilated) {
  for (int i = 0; i < rows; ++i) {
    if (columns[i] == 0) continue;
    dilateRow(dilation, source + i * dilation.row_step, spanOf(columns[i]),
              dilated + i * dilation.words);
  }
}

inline int replace(const std::uint64_t* words, int count, std::uint64_t* target) {
  int more = 0;
  for (int w = 0; w < count; ++w) {
    if (words[w] == target[w]) continue;  // mostly
    more += countBits(words[w]) - countBits(target[w]);
    target[w] = words[w];
  }
  return more;
}

inline int replaceRows(const Strip* words, const std::uint32_t* columns, int rows,
                       std::uint64_t* target) {
  int more = 0;
  for (int i = 0; i < rows; ++i, target += Strip::kColumns) {
    if (columns[i] == 0) continue;
    const auto [first, end] = spanOf(columns[i]);
    more += replace(words[i].words + first, end - first, target + first);
  }
  return more;
}

inline int add(const std::uint64_t* words, int row_step, int rows, int count, std::uint64_t* target,
               int target_step) {
  int more = 0;
  for (int i = 0; i < rows; ++i, words += row_step, target += target_step) {
    for (int w = 0; w < count; ++w) {
      more += countBits(words[w] & ~target[w]);
      target[w] |= words[w];
    }
  }
  return more;
}

}  // namespace fiimap::plain
