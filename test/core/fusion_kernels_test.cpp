#include <vector>

#include "kernels_fixture.h"

namespace fiimap {
namespace {

using FusionKernels = test::KernelsTest;

TEST_P(FusionKernels, Observe) {
  for (int round = 0; round < kRounds; ++round) {
    MapperConfig config;
    if (round % 2 == 0) config.p_hit = 0.99;  // steps are larger than the range: limits below 127
    const LogOdds l{config};
    const int words = test::uniformInt(random_, 0, 5);
    std::vector<std::uint64_t> hit(words), free(words), known(words), occupied(words);
    std::vector<std::int8_t> values(words * kWordBits);
    for (std::int8_t& value : values) {
      value = static_cast<std::int8_t>(test::uniformInt(random_, l.min, l.max));
    }
    for (int w = 0; w < words; ++w) {
      hit[w] = randomWord();
      free[w] = randomWord() & ~hit[w];
      known[w] = randomWord();
      occupied[w] = randomWord();
    }
    std::vector<std::uint64_t> expected_occupied = occupied;
    std::vector<std::int8_t> expected = values;
    plain_.observe(l, words, hit.data(), free.data(), known.data(), expected_occupied.data(),
                   expected.data());
    tested_.observe(l, words, hit.data(), free.data(), known.data(), occupied.data(),
                    values.data());
    ASSERT_EQ(occupied, expected_occupied);
    for (int i = 0; i < words * kWordBits; ++i) {
      const std::uint64_t has_value =
          hit[i / kWordBits] | free[i / kWordBits] | known[i / kWordBits];
      if (((has_value >> (i % kWordBits)) & 1u) == 0) continue;
      ASSERT_EQ(values[i], expected[i]) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, FusionKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

}  // namespace
}  // namespace fiimap
