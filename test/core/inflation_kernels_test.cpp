#include <vector>

#include "fiimap/bit_column.h"
#include "kernels_fixture.h"

namespace fiimap {
namespace {

using InflationKernels = test::KernelsTest;

/// Some columns of a strip, at least one.
StripSpan randomSpan(test::Random& random) {
  const int first = test::uniformInt(random, 0, Strip::kColumns - 1);
  return {first, test::uniformInt(random, first + 1, Strip::kColumns)};
}

TEST_P(InflationKernels, Widen) {
  for (int round = 0; round < kRounds; ++round) {
    const StripSpan span = randomSpan(random_);
    const int reach = test::uniformInt(random_, 0, 12);
    std::vector<std::uint64_t> row(Strip::kColumns + 2 * reach);
    for (std::uint64_t& word : row) word = randomWord() & randomWord() & randomWord();
    std::vector<Strip> widened(reach + 1);
    tested_.widen(row.data() + reach, span, reach, widened.data());
    for (int c = span.first; c < span.end; ++c) {
      std::uint64_t expected = 0;
      for (int k = 0; k <= reach; ++k) {
        expected |= row[reach + c - k] | row[reach + c + k];
        ASSERT_EQ(widened[k].words[c], expected) << "column " << c << ", half width " << k;
      }
    }
  }
}

TEST_P(InflationKernels, Dilate) {
  for (int round = 0; round < kRounds; ++round) {
    constexpr int kStrips = 9;  // of each word; the row's own is the middle one
    ColumnDilation dilation;
    dilation.words = 1 << test::uniformInt(random_, 0, 3);
    dilation.word_step = kStrips;
    for (int w = 0; w < dilation.words; ++w) {
      dilation.not_top.push_back(randomWord());
      dilation.not_bottom.push_back(randomWord());
    }
    const int steps = test::uniformInt(random_, 0, 5);
    for (int step = 0; step <= steps; ++step) {
      const int added = test::uniformInt(random_, step == 0 ? 1 : 0, 3);
      for (int i = 0; i < added; ++i) {
        dilation.sources.push_back(test::uniformInt(random_, -kStrips / 2, kStrips / 2));
      }
      dilation.sources_end.push_back(static_cast<int>(dilation.sources.size()));
    }
    std::vector<Strip> source(kStrips * dilation.words);
    for (Strip& strip : source) {
      for (std::uint64_t& word : strip.words) word = randomWord() & randomWord() & randomWord();
    }
    const StripSpan span = randomSpan(random_);
    std::vector<Strip> expected(dilation.words), dilated(dilation.words);
    plain_.dilate(dilation, source.data() + kStrips / 2, span, expected.data());
    tested_.dilate(dilation, source.data() + kStrips / 2, span, dilated.data());
    for (int w = 0; w < dilation.words; ++w) {
      for (int c = span.first; c < span.end; ++c) {
        ASSERT_EQ(dilated[w].words[c], expected[w].words[c]) << "word " << w << ", column " << c;
      }
    }
  }
}

TEST_P(InflationKernels, Replace) {
  for (int round = 0; round < kRounds; ++round) {
    const int count = test::uniformInt(random_, 0, 70);
    // No word after the last one, so that a sanitizer sees who writes too far.
    std::vector<std::uint64_t> words(count), target(count);
    int expected = 0;
    for (int w = 0; w < count; ++w) {
      words[w] = randomWord();
      target[w] = test::chance(random_, 0.7) ? words[w] : randomWord();
      forEachBit(&words[w], 1, [&](int) { ++expected; });
      forEachBit(&target[w], 1, [&](int) { --expected; });
    }
    ASSERT_EQ(tested_.replace(words.data(), count, target.data()), expected);
    ASSERT_EQ(target, words);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, InflationKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

}  // namespace
}  // namespace fiimap
