#include "fiimap/bit_column.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

/// Bits with runs that are long and short, empty and full words included.
std::vector<std::uint64_t> randomWords(test::Random& random, std::vector<bool>* bits) {
  const int count = test::uniformInt(random, 1, 4);
  std::vector<std::uint64_t> words(count, 0);
  bits->assign(count * kWordBits, false);
  bool value = test::chance(random, 0.5);
  const double change = test::uniformReal(random, 0.0, 0.5);
  for (int i = 0; i < count * kWordBits; ++i) {
    if (test::chance(random, change)) value = !value;
    (*bits)[i] = value;
    if (value) words[i / kWordBits] |= std::uint64_t{1} << (i % kWordBits);
  }
  return words;
}

TEST(BitColumnTest, VisitsEverySetBitLowestFirst) {
  test::Random random(111);
  for (int round = 0; round < 500; ++round) {
    std::vector<bool> bits;
    const std::vector<std::uint64_t> words = randomWords(random, &bits);
    std::vector<int> expected, visited;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (bits[i]) expected.push_back(static_cast<int>(i));
    }
    forEachBit(words.data(), static_cast<int>(words.size()),
               [&](int bit) { visited.push_back(bit); });
    ASSERT_EQ(visited, expected) << "seed 111, round " << round;
  }
}

TEST(BitColumnTest, VisitsEveryRunOnceAndWhole) {
  test::Random random(112);
  for (int round = 0; round < 1000; ++round) {
    std::vector<bool> bits;
    const std::vector<std::uint64_t> words = randomWords(random, &bits);
    std::vector<std::pair<int, int>> expected, visited;
    for (int i = 0; i < static_cast<int>(bits.size()); ++i) {
      if (!bits[i]) continue;
      const bool continues = i > 0 && bits[i - 1];
      if (continues) {
        expected.back().second = i;
      } else {
        expected.emplace_back(i, i);
      }
    }
    forEachRun(words.data(), static_cast<int>(words.size()),
               [&](int first, int last) { visited.emplace_back(first, last); });
    ASSERT_EQ(visited, expected) << "seed 112, round " << round;
  }
}

}  // namespace
}  // namespace fiimap
