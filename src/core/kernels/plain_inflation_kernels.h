#pragma once

// Dilation of bit columns, in plain C++ that compilers turn into vectors.

#include <cstdint>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

/// Whole groups, so that compilers' vectors fit.
inline StripSpan wholeGroups(const StripSpan& span) {
  return {span.first / kGroup * kGroup, (span.end + kGroup - 1) / kGroup * kGroup};
}

inline void widen(const std::uint64_t* row, StripSpan span, int reach, Strip* widened) {
  const auto [first, end] = wholeGroups(span);
  for (int c = first; c < end; ++c) widened->words[c] = row[c];
  for (int k = 1; k <= reach; ++k) {
    const std::uint64_t* const narrower = widened[k - 1].words;
    std::uint64_t* const wider = widened[k].words;
    for (int c = first; c < end; ++c) wider[c] = narrower[c] | row[c - k] | row[c + k];
  }
}

/// One voxel up and down.
inline void dilateAlongZ(const ColumnDilation& dilation, int first, int end, Strip* columns) {
  constexpr int kCarry = kWordBits - 1;
  const int last = dilation.words - 1;
  for (int c = first; c < end; ++c) {
    const std::uint64_t first_word = columns[0].words[c];
    std::uint64_t below = columns[last].words[c] & dilation.not_top[last];
    for (int w = 0; w <= last; ++w) {
      const std::uint64_t word = columns[w].words[c];
      const std::uint64_t up = word & dilation.not_top[w];
      const std::uint64_t down = word & dilation.not_bottom[w];
      const std::uint64_t above = w == last ? first_word & dilation.not_bottom[0]
                                            : columns[w + 1].words[c] & dilation.not_bottom[w + 1];
      columns[w].words[c] =
          word | (up << 1) | (below >> kCarry) | (down >> 1) | (above << kCarry);
      below = up;
    }
  }
}

inline void dilate(const ColumnDilation& dilation, const Strip* source, StripSpan span,
                   Strip* dilated) {
  const auto [first, end] = wholeGroups(span);
  for (int w = 0; w < dilation.words; ++w) {
    for (int c = first; c < end; ++c) dilated[w].words[c] = 0;
  }
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) dilateAlongZ(dilation, first, end, dilated);
    for (; s < sources_end; ++s) {
      for (int w = 0; w < dilation.words; ++w) {
        const std::uint64_t* const added = source[w * dilation.word_step + dilation.sources[s]].words;
        for (int c = first; c < end; ++c) dilated[w].words[c] |= added[c];
      }
    }
  }
}

inline int replace(const std::uint64_t* words, int count, std::uint64_t* target) {
  int more = 0;
  for (int w = 0; w < count; ++w) {
    // Counting bits is slow without an instruction for it, and few words differ.
    if (words[w] == target[w]) continue;
    more += __builtin_popcountll(words[w]) - __builtin_popcountll(target[w]);
    target[w] = words[w];
  }
  return more;
}

}  // namespace fiimap::plain
