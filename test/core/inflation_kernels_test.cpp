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

/// Bits of some columns of a row, none in one of a few rows.
std::uint32_t randomColumns(test::Random& random) {
  const StripSpan span = randomSpan(random);
  const std::uint32_t all = ~std::uint32_t{0};
  const std::uint32_t in_span = (all << span.first) & (all >> (Strip::kColumns - span.end));
  return test::chance(random, 0.2) ? 0 : in_span & static_cast<std::uint32_t>(random());
}

TEST_P(InflationKernels, Widen) {
  for (int round = 0; round < kRounds; ++round) {
    const StripSpan span = randomSpan(random_);
    const int reach = test::uniformInt(random_, 0, 12);
    const int rows = test::uniformInt(random_, 1, 5);
    const int row_step = Strip::kColumns + 2 * reach + test::uniformInt(random_, 0, 3);
    std::vector<std::uint64_t> words(rows * row_step);
    for (std::uint64_t& word : words) word = randomWord() & randomWord() & randomWord();
    std::vector<Strip> widened(rows * (reach + 1));
    tested_.widen(words.data() + reach, row_step, rows, span, reach, widened.data());
    for (int i = 0; i < rows; ++i) {
      const std::uint64_t* const row = words.data() + i * row_step + reach;
      for (int c = span.first; c < span.end; ++c) {
        std::uint64_t expected = 0;
        for (int k = 0; k <= reach; ++k) {
          expected |= row[c - k] | row[c + k];
          ASSERT_EQ(widened[i * (reach + 1) + k].words[c], expected)
              << "row " << i << ", column " << c << ", half width " << k;
        }
      }
    }
  }
}

TEST_P(InflationKernels, Dilate) {
  for (int round = 0; round < kRounds; ++round) {
    constexpr int kStrips = 9;  // of each word; the row's own is the middle one
    ColumnDilation dilation;
    dilation.words = 1 << test::uniformInt(random_, 0, 3);
    dilation.row_step = test::uniformInt(random_, 1, 3);
    const int rows = test::uniformInt(random_, 1, 4);
    dilation.word_step = kStrips + (rows - 1) * dilation.row_step;
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
    std::vector<Strip> source(dilation.word_step * dilation.words);
    for (Strip& strip : source) {
      for (std::uint64_t& word : strip.words) word = randomWord() & randomWord() & randomWord();
    }
    std::vector<std::uint32_t> columns(rows);
    for (std::uint32_t& bits : columns) bits = randomColumns(random_);
    const Strip* const first_source = source.data() + kStrips / 2;
    std::vector<Strip> expected(rows * dilation.words), dilated(rows * dilation.words);
    plain_.dilate(dilation, first_source, columns.data(), rows, expected.data());
    tested_.dilate(dilation, first_source, columns.data(), rows, dilated.data());
    for (int strip = 0; strip < rows * dilation.words; ++strip) {
      const std::uint32_t bits = columns[strip / dilation.words];
      if (bits == 0) continue;
      const StripSpan span = spanOf(bits);
      for (int c = span.first; c < span.end; ++c) {
        ASSERT_EQ(dilated[strip].words[c], expected[strip].words[c])
            << "strip " << strip << ", column " << c;
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

TEST_P(InflationKernels, ReplaceRows) {
  for (int round = 0; round < kRounds; ++round) {
    const int rows = test::uniformInt(random_, 1, 5);
    std::vector<Strip> strips(rows);
    std::vector<std::uint32_t> columns(rows);
    std::vector<std::uint64_t> target(rows * Strip::kColumns);
    for (std::uint64_t& word : target) word = randomWord();
    for (std::uint32_t& bits : columns) bits = randomColumns(random_);
    std::vector<std::uint64_t> expected = target;
    int more = 0;
    for (int i = 0; i < rows; ++i) {
      const StripSpan span = columns[i] == 0 ? StripSpan{0, 0} : spanOf(columns[i]);
      for (int c = 0; c < Strip::kColumns; ++c) {
        std::uint64_t& word = expected[i * Strip::kColumns + c];
        std::uint64_t& replacing = strips[i].words[c];
        replacing = test::chance(random_, 0.5) ? word : randomWord();
        if (c < span.first || c >= span.end) continue;
        more += countBits(replacing) - countBits(word);
        word = replacing;
      }
    }
    ASSERT_EQ(tested_.replaceRows(strips.data(), columns.data(), rows, target.data()), more);
    ASSERT_EQ(target, expected);
  }
}

TEST_P(InflationKernels, Add) {
  for (int round = 0; round < kRounds; ++round) {
    const int count = Strip::kGroup * test::uniformInt(random_, 1, 5);
    const int rows = test::uniformInt(random_, 1, 5);
    const int row_step = count + test::uniformInt(random_, 0, 9);
    const int target_step = count + test::uniformInt(random_, 0, 9);
    std::vector<std::uint64_t> words((rows - 1) * row_step + count);
    std::vector<std::uint64_t> target((rows - 1) * target_step + count);
    for (std::uint64_t& word : words) word = randomWord();
    for (std::uint64_t& word : target) word = randomWord();
    std::vector<std::uint64_t> expected = target;
    int more = 0;
    for (int i = 0; i < rows; ++i) {
      for (int w = 0; w < count; ++w) {
        std::uint64_t& word = expected[i * target_step + w];
        more += countBits(words[i * row_step + w] & ~word);
        word |= words[i * row_step + w];
      }
    }
    ASSERT_EQ(tested_.add(words.data(), row_step, rows, count, target.data(), target_step), more);
    ASSERT_EQ(target, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, InflationKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

}  // namespace
}  // namespace fiimap
