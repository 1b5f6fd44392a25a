// Dilation of bit columns, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_INFLATION_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_INFLATION_KERNELS_H
#undef FIIMAP_VECTOR_INFLATION_KERNELS_H
#else
#define FIIMAP_VECTOR_INFLATION_KERNELS_H
#endif

#include <cstdint>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "vectors.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

constexpr int kWordLanes = static_cast<int>(hn::MaxLanes(Words()));
/// Columns that are dilated together, in registers.
constexpr int kDilatedColumns = 16;

HWY_INLINE int roundDown(int column, int block) { return column & -block; }

void widen(const std::uint64_t* row, StripSpan span, int reach, Strip* widened) {
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

/// A word of neighbouring columns.
struct WordBlock {
  static constexpr int kVectors = kDilatedColumns / kWordLanes;
  /// Written down, because compilers make it without this instruction set.
  HWY_INLINE WordBlock() {}
  WordVector part[kVectors];
};

HWY_INLINE WordBlock zeroBlock() {
  WordBlock block;
  for (auto& part : block.part) part = hn::Zero(Words());
  return block;
}

HWY_INLINE WordBlock loadBlock(const std::uint64_t* words) {
  WordBlock block;
  for (int i = 0; i < WordBlock::kVectors; ++i) {
    block.part[i] = hn::Load(Words(), words + i * kWordLanes);
  }
  return block;
}

HWY_INLINE void storeBlock(const WordBlock& block, std::uint64_t* words) {
  for (int i = 0; i < WordBlock::kVectors; ++i) {
    hn::Store(block.part[i], Words(), words + i * kWordLanes);
  }
}

HWY_INLINE WordBlock masked(const WordBlock& block, std::uint64_t mask) {
  WordBlock result;
  for (int i = 0; i < WordBlock::kVectors; ++i) {
    result.part[i] = hn::And(block.part[i], hn::Set(Words(), mask));
  }
  return result;
}

/// Adds the strips that are `sources` away.
HWY_INLINE void addSources(const Strip* source, const std::int32_t* sources, int count, int column,
                           WordBlock* sum) {
  WordBlock all = *sum;
  for (int s = 0; s < count; ++s) {
    const std::uint64_t* const words = source[sources[s]].words + column;
    for (int i = 0; i < WordBlock::kVectors; ++i) {
      all.part[i] = hn::Or(all.part[i], hn::Load(Words(), words + i * kWordLanes));
    }
  }
  *sum = all;
}

/// Adds the bits that move up by one, of the word itself and of that below it, and down.
HWY_INLINE void addShifted(const WordBlock& up, const WordBlock& up_below, const WordBlock& down,
                           const WordBlock& down_above, WordBlock* word) {
  constexpr int kCarry = kWordBits - 1;
  for (int i = 0; i < WordBlock::kVectors; ++i) {
    const auto risen =
        hn::Or(hn::ShiftLeft<1>(up.part[i]), hn::ShiftRight<kCarry>(up_below.part[i]));
    const auto sunk =
        hn::Or(hn::ShiftRight<1>(down.part[i]), hn::ShiftLeft<kCarry>(down_above.part[i]));
    word->part[i] = hn::Or(word->part[i], hn::Or(risen, sunk));
  }
}

/// Columns of one word, which stays in registers: with dilateTall() all of inflation takes 14 %
/// more.
HWY_INLINE void dilateLow(const ColumnDilation& dilation, const Strip* source, int column,
                          Strip* dilated) {
  WordBlock word = zeroBlock();
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) {
      const WordBlock up = masked(word, dilation.not_top[0]);
      const WordBlock down = masked(word, dilation.not_bottom[0]);
      addShifted(up, up, down, down, &word);
    }
    addSources(source, dilation.sources.data() + s, sources_end - s, column, &word);
    s = sources_end;
  }
  storeBlock(word, dilated->words + column);
}

/// One voxel up and down.
HWY_INLINE void dilateAlongZ(const ColumnDilation& dilation, int column, Strip* dilated) {
  const int last = dilation.words - 1;
  const WordBlock first_word = loadBlock(dilated[0].words + column);
  WordBlock up_below = masked(loadBlock(dilated[last].words + column), dilation.not_top[last]);
  WordBlock word = first_word;
  for (int w = 0; w <= last; ++w) {
    const WordBlock above = w < last ? loadBlock(dilated[w + 1].words + column) : first_word;
    const WordBlock up = masked(word, dilation.not_top[w]);
    const WordBlock down = masked(word, dilation.not_bottom[w]);
    addShifted(up, up_below, down, masked(above, dilation.not_bottom[w < last ? w + 1 : 0]), &word);
    storeBlock(word, dilated[w].words + column);
    up_below = up;
    word = above;
  }
}

HWY_INLINE void dilateTall(const ColumnDilation& dilation, const Strip* source, int column,
                           Strip* dilated) {
  int s = 0;
  for (const int sources_end : dilation.sources_end) {
    if (s > 0) dilateAlongZ(dilation, column, dilated);
    for (int w = 0; w < dilation.words; ++w) {
      WordBlock word = s > 0 ? loadBlock(dilated[w].words + column) : zeroBlock();
      addSources(source + w * dilation.word_step, dilation.sources.data() + s, sources_end - s,
                 column, &word);
      storeBlock(word, dilated[w].words + column);
    }
    s = sources_end;
  }
}

void dilate(const ColumnDilation& dilation, const Strip* source, StripSpan span, Strip* dilated) {
  for (int c = roundDown(span.first, kDilatedColumns); c < span.end; c += kDilatedColumns) {
    if (dilation.words == 1) {
      dilateLow(dilation, source, c, dilated);
    } else {
      dilateTall(dilation, source, c, dilated);
    }
  }
}

int replace(const std::uint64_t* words, int count, std::uint64_t* target) {
  const Words d;
  auto more = hn::Zero(d);
  int w = 0;
  for (; w + kWordLanes <= count; w += kWordLanes) {
    const auto before = hn::LoadU(d, target + w);
    const auto after = hn::LoadU(d, words + w);
    if (hn::AllTrue(d, hn::Eq(before, after))) continue;  // mostly
    more = hn::Add(more, hn::Sub(hn::PopulationCount(after), hn::PopulationCount(before)));
    hn::StoreU(after, d, target + w);
  }
  int sum = static_cast<int>(hn::GetLane(hn::SumOfLanes(d, more)));
  for (; w < count; ++w) {
    sum += countBits(words[w]) - countBits(target[w]);
    target[w] = words[w];
  }
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
