// Dilation of bit columns, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_INFLATION_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_INFLATION_KERNELS_H
#undef FIIMAP_VECTOR_INFLATION_KERNELS_H
#else
#define FIIMAP_VECTOR_INFLATION_KERNELS_H
#endif

#include <algorithm>
#include <cstdint>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "vectors.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

constexpr int kWordLanes = static_cast<int>(hn::MaxLanes(Words()));
///@{
/// Columns that are dilated together, in registers. With few alone, 10 voxels of inflation take 15
/// % more; with many alone, the narrow rows around single voxels 3 %.
constexpr int kManyColumns = 16;
constexpr int kFewColumns = 8;
///@}

HWY_INLINE int roundDown(int column, int block) { return column & -block; }

HWY_INLINE void widenRow(const std::uint64_t* row, StripSpan span, int reach, Strip* widened) {
  const Words d;
  for (int c = roundDown(span.first, kWordLanes); c < span.end; c += kWordLanes) {
    auto all = hn::LoadU(d, row + c);
    hn::Store(all, d, widened->words + c);
    for (int k = 1; k <= reach; ++k) {
      all = hn::Or(all, hn::Or(hn::LoadU(d, row + c - k), hn::LoadU(d, row + c + k)));
      hn::Store(all, d, widened[k].words + c);
    }
  }
}

void widen(const std::uint64_t* row, int row_step, int rows, StripSpan span, int reach,
           Strip* widened) {
  for (int i = 0; i < rows; ++i) {
    widenRow(row + i * row_step, span, reach, widened + i * (reach + 1));
  }
}

/// A word of neighbouring columns.
template <int kColumns>
struct WordBlock {
  static constexpr int kVectors = kColumns / kWordLanes;
  /// Written down, because compilers make it without this instruction set.
  HWY_INLINE WordBlock() {}
  WordVector part[kVectors];
};

template <int kColumns>
HWY_INLINE WordBlock<kColumns> zeroBlock() {
  WordBlock<kColumns> block;
  for (auto& part : block.part) part = hn::Zero(Words());
  return block;
}

template <int kColumns>
HWY_INLINE WordBlock<kColumns> loadBlock(const std::uint64_t* words) {
  WordBlock<kColumns> block;
  for (int i = 0; i < block.kVectors; ++i) {
    block.part[i] = hn::Load(Words(), words + i * kWordLanes);
  }
  return block;
}

template <int kColumns>
HWY_INLINE void storeBlock(const WordBlock<kColumns>& block, std::uint64_t* words) {
  for (int i = 0; i < block.kVectors; ++i) {
    hn::Store(block.part[i], Words(), words + i * kWordLanes);
  }
}

template <int kColumns>
HWY_INLINE WordBlock<kColumns> masked(const WordBlock<kColumns>& block, std::uint64_t mask) {
  WordBlock<kColumns> result;
  for (int i = 0; i < result.kVectors; ++i) {
    result.part[i] = hn::And(block.part[i], hn::Set(Words(), mask));
  }
  return result;
}

/// Adds the strips that are `sources` away.
template <int kColumns>
HWY_INLINE void addSources(const Strip* source, const std::int32_t* sources, int count, int column,
                           WordBlock<kColumns>* sum) {
  WordBlock<kColumns> all = *sum;
  for (int s = 0; s < count; ++s) {
    const std::uint64_t* const words = source[sources[s]].words + column;
    for (int i = 0; i < all.kVectors; ++i) {
      all.part[i] = hn::Or(all.part[i], hn::Load(Words(), words + i * kWordLanes));
    }
  }
  *sum = all;
}

/// Adds the bits that move up by one, of the word itself and of that below it, and down.
template <int kColumns>
HWY_INLINE void addShifted(const WordBlock<kColumns>& up, const WordBlock<kColumns>& up_below,
                           const WordBlock<kColumns>& down, const WordBlock<kColumns>& down_above,
                           WordBlock<kColumns>* word) {
  constexpr int kCarry = kWordBits - 1;
  for (int i = 0; i < up.kVectors; ++i) {
    const auto risen =
        hn::Or(hn::ShiftLeft<1>(up.part[i]), hn::ShiftRight<kCarry>(up_below.part[i]));
    const auto sunk =
        hn::Or(hn::ShiftRight<1>(down.part[i]), hn::ShiftLeft<kCarry>(down_above.part[i]));
    word->part[i] = hn::Or(word->part[i], hn::Or(risen, sunk));
  }
}

/// Columns of one word, which stays in registers: with dilateTall() all of inflation takes 14 %
/// more.
template <int kColumns>
HWY_INLINE void dilateLow(const ColumnDilation& dilation, const Strip* source, int column,
                          Strip* dilated) {
  WordBlock<kColumns> word = zeroBlock<kColumns>();
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) {
      const WordBlock<kColumns> up = masked(word, dilation.not_top[0]);
      const WordBlock<kColumns> down = masked(word, dilation.not_bottom[0]);
      addShifted(up, up, down, down, &word);
    }
    addSources(source, dilation.sources.data() + s, sources_end - s, column, &word);
    s = sources_end;
  }
  storeBlock(word, dilated->words + column);
}

/// One voxel up and down.
template <int kColumns>
HWY_INLINE void dilateAlongZ(const ColumnDilation& dilation, int column, Strip* dilated) {
  const int last = dilation.words - 1;
  const WordBlock<kColumns> first_word = loadBlock<kColumns>(dilated[0].words + column);
  WordBlock<kColumns> up_below =
      masked(loadBlock<kColumns>(dilated[last].words + column), dilation.not_top[last]);
  WordBlock<kColumns> word = first_word;
  for (int w = 0; w <= last; ++w) {
    const WordBlock<kColumns> above =
        w < last ? loadBlock<kColumns>(dilated[w + 1].words + column) : first_word;
    const WordBlock<kColumns> up = masked(word, dilation.not_top[w]);
    const WordBlock<kColumns> down = masked(word, dilation.not_bottom[w]);
    addShifted(up, up_below, down, masked(above, dilation.not_bottom[w < last ? w + 1 : 0]), &word);
    storeBlock(word, dilated[w].words + column);
    up_below = up;
    word = above;
  }
}

template <int kColumns>
HWY_INLINE void dilateTall(const ColumnDilation& dilation, const Strip* source, int column,
                           Strip* dilated) {
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) dilateAlongZ<kColumns>(dilation, column, dilated);
    for (int w = 0; w < dilation.words; ++w) {
      WordBlock<kColumns> word =
          s > 0 ? loadBlock<kColumns>(dilated[w].words + column) : zeroBlock<kColumns>();
      addSources(source + w * dilation.word_step, dilation.sources.data() + s, sources_end - s,
                 column, &word);
      storeBlock(word, dilated[w].words + column);
    }
    s = sources_end;
  }
}

template <int kColumns>
HWY_INLINE void dilateBlock(const ColumnDilation& dilation, const Strip* source, int column,
                            Strip* dilated) {
  if (dilation.words == 1) {
    dilateLow<kColumns>(dilation, source, column, dilated);
  } else {
    dilateTall<kColumns>(dilation, source, column, dilated);
  }
}

HWY_INLINE void dilateRow(const ColumnDilation& dilation, const Strip* source, StripSpan span,
                          Strip* dilated) {
  int c = roundDown(span.first, kFewColumns);
  for (; c + kFewColumns < span.end; c += kManyColumns) {
    dilateBlock<kManyColumns>(dilation, source, c, dilated);
  }
  if (c < span.end) dilateBlock<kFewColumns>(dilation, source, c, dilated);
}

void dilate(const ColumnDilation& dilation, const Strip* source, const std::uint32_t* columns,
            int rows, Strip* dilated) {
  for (int i = 0; i < rows; ++i) {
    if (columns[i] == 0) continue;
    dilateRow(dilation, source + i * dilation.row_step, spanOf(columns[i]),
              dilated + i * dilation.words);
  }
}

/// Number of set bits of each word. By bytes: with Highway's count for words, add() takes 40 % more
/// instructions.
HWY_INLINE WordVector countBits(WordVector words) {
  const hn::Repartition<std::uint8_t, Words> bytes;
  return hn::SumsOf8(hn::PopulationCount(hn::BitCast(bytes, words)));
}

int replace(const std::uint64_t* words, int count, std::uint64_t* target) {
  const Words d;
  auto more = hn::Zero(d);
  int w = 0;
  for (; w + kWordLanes <= count; w += kWordLanes) {
    const auto before = hn::LoadU(d, target + w);
    const auto after = hn::LoadU(d, words + w);
    if (hn::AllTrue(d, hn::Eq(before, after))) continue;  // mostly
    more = hn::Add(more, hn::Sub(countBits(after), countBits(before)));
    hn::StoreU(after, d, target + w);
  }
  int sum = static_cast<int>(hn::GetLane(hn::SumOfLanes(d, more)));
  for (; w < count; ++w) {
    sum += fiimap::countBits(words[w]) - fiimap::countBits(target[w]);
    target[w] = words[w];
  }
  return sum;
}

/// Not by replace(), row by row: the loop over its last words has branches that cannot be guessed.
/// With it, inflation of a dozen voxels takes 12 % more.
int replaceRows(const Strip* words, const std::uint32_t* columns, int rows, std::uint64_t* target) {
  const Words d;
  auto more = hn::Zero(d);
  for (int i = 0; i < rows; ++i, target += Strip::kColumns) {
    if (columns[i] == 0) continue;
    const StripSpan span = spanOf(columns[i]);
    for (int c = roundDown(span.first, kWordLanes); c < span.end; c += kWordLanes) {
      const auto before = hn::LoadU(d, target + c);
      const auto is_before_span = hn::FirstN(d, std::max(span.first - c, 0));
      const auto is_in_span = hn::AndNot(is_before_span, hn::FirstN(d, span.end - c));
      const auto after = hn::IfThenElse(is_in_span, hn::Load(d, words[i].words + c), before);
      more = hn::Add(more, hn::Sub(countBits(after), countBits(before)));
      hn::StoreU(after, d, target + c);
    }
  }
  return static_cast<int>(hn::GetLane(hn::SumOfLanes(d, more)));
}

int add(const std::uint64_t* words, int row_step, int rows, int count, std::uint64_t* target,
        int target_step) {
  const Words d;
  auto more = hn::Zero(d);
  for (int i = 0; i < rows; ++i, words += row_step, target += target_step) {
    for (int w = 0; w < count; w += kWordLanes) {
      const auto before = hn::LoadU(d, target + w);
      const auto added = hn::LoadU(d, words + w);
      more = hn::Add(more, countBits(hn::AndNot(before, added)));
      hn::StoreU(hn::Or(before, added), d, target + w);
    }
  }
  return static_cast<int>(hn::GetLane(hn::SumOfLanes(d, more)));
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
