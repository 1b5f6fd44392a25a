#include <cmath>
#include <vector>

#include "kernels_fixture.h"

namespace fiimap {
namespace {

using RayKernels = test::KernelsTest;

ColumnLine randomLine(test::Random& random) {
  ColumnLine line;
  line.slabs = test::uniformInt(random, 1, 90);
  const float minor_origin = static_cast<float>(test::uniformReal(random, 30.0, 60.0));
  const float slope = static_cast<float>(test::uniformReal(random, -0.3, 0.3));
  const float length = line.slabs - 0.25f;
  line.start_t = test::chance(random, 0.2) ? 0.25f : 0.0f;
  line.end_t = 1.0f;
  line.first_border = -0.25f;
  line.major_step = 1.0f;
  line.t_per_major = line.slabs > 1 ? 1.0f / length : 0.0f;
  line.minor_origin = minor_origin;
  line.minor_direction = slope * length;
  line.minor_step = slope > 0.0f ? 1 : -1;
  line.minor_border = (slope > 0.0f ? 1.0f : 0.0f) - minor_origin;
  line.t_per_minor = 1.0f / line.minor_direction;
  line.last_minor_cell = 99;
  line.first_column = 200;
  line.major_offset = 200;
  line.minor_offset = 2;
  return line;
}

/// A line of RaySlices: t is the distance, the slope that of a cell. Origins whose fractions along
/// both axes belong together make diagonals cross borders of both at once, where rounding decides.
ColumnLine sliceLine(test::Random& random) {
  constexpr int kSide = 200;  // of the box, columns
  const int half_side = test::uniformInt(random, 1, kSide / 2);
  const int cell = test::chance(random, 0.5) ? half_side * (test::chance(random, 0.5) ? 1 : -1)
                                             : test::uniformInt(random, -half_side, half_side);
  const double fraction = test::uniformReal(random, 0.0, 1.0);
  const double noise = test::uniformReal(random, -1e-5, 1e-5);
  const double other = test::chance(random, 0.5) ? fraction + noise : 1.0 - fraction + noise;
  const auto origin = static_cast<float>(kSide / 2 + fraction);
  const auto minor_origin =
      static_cast<float>(test::uniformInt(random, 0, kSide - 2) + std::abs(other));
  const bool forward = test::chance(random, 0.5);
  const auto start = static_cast<int>(origin);
  ColumnLine line;
  line.end_t = static_cast<float>(half_side - test::uniformReal(random, 0.25, 1.0));
  line.slabs =
      std::abs(static_cast<int>(forward ? origin + line.end_t : origin - line.end_t) - start) + 1;
  line.start_t = 0.0f;
  line.first_border = forward ? start - origin : origin - (start + 1);
  line.major_step = 1.0f;
  line.t_per_major = 1.0f;
  line.minor_origin = minor_origin;
  line.minor_direction = static_cast<float>(cell) / static_cast<float>(half_side);
  line.minor_step = cell > 0 ? 1 : -1;
  line.minor_border = (cell > 0 ? 1.0f : 0.0f) - minor_origin;
  line.t_per_minor = cell != 0 ? 1.0f / line.minor_direction : 0.0f;
  line.last_minor_cell = kSide - 1;
  line.first_column = start * kSide;
  line.major_offset = forward ? kSide : -kSide;
  line.minor_offset = 1;
  return line;
}

TEST_P(RayKernels, Walk) {
  constexpr int kLines = 5000;  // rounding decides in few of them
  for (int round = 0; round < kLines; ++round) {
    const ColumnLine line = round % 10 == 0 ? randomLine(random_) : sliceLine(random_);
    ColumnWalk expected, walk;
    plain_.walk(line, &expected);
    tested_.walk(line, &walk);
    ASSERT_EQ(walk.size, expected.size);
    ASSERT_GE(walk.size, line.slabs);
    for (int k = 0; k < walk.size; ++k) ASSERT_EQ(walk.column[k], expected.column[k]) << k;
    for (int k = 0; k <= walk.size; ++k) ASSERT_EQ(walk.t[k], expected.t[k]) << k;
    for (int i = 0; i <= line.slabs; ++i) {
      ASSERT_EQ(walk.first_of_slab[i], expected.first_of_slab[i]) << i;
    }
    for (int i = 0; i < line.slabs; ++i) {
      const int columns = walk.first_of_slab[i + 1] - walk.first_of_slab[i];
      ASSERT_TRUE(columns == 1 || columns == 2) << columns << " in slab " << i;
    }
  }
}

TEST_P(RayKernels, FreeRuns) {
  for (int round = 0; round < kRounds; ++round) {
    constexpr int kWords = 3;
    constexpr int kColumns = 100;
    const int height = test::uniformInt(random_, 1, kWords * kWordBits);
    std::vector<std::int32_t> column(kColumns + kVectorRoom);
    std::vector<float> t(kColumns + 1 + kVectorRoom);
    for (int k = 0; k < kColumns; ++k) column[k] = k * kWords;
    for (int k = 0; k <= kColumns; ++k) t[k] = static_cast<float>(k) / kColumns;
    std::vector<float> rise_low(test::uniformInt(random_, 0, 4)), rise_high;
    for (float& rise : rise_low) {
      rise = uniform(-height, height);
      rise_high.push_back(rise + uniform(0.0, 20.0));
    }
    RayRuns part;
    part.column = column.data();
    part.t = t.data();
    part.columns = test::uniformInt(random_, 0, kColumns);
    part.origin_z = uniform(-10.0, height + 10.0);
    part.rise_low = rise_low.data();
    part.rise_high = rise_high.data();
    part.runs = static_cast<int>(rise_low.size());
    std::vector<std::uint64_t> expected(kWords * kColumns);
    for (std::uint64_t& word : expected) word = test::chance(random_, 0.5) ? 0 : randomWord();
    std::vector<std::uint64_t> free = expected;
    plain_.freeRuns(part, height, expected.data());
    tested_.freeRuns(part, height, free.data());
    ASSERT_EQ(free, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, RayKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

}  // namespace
}  // namespace fiimap
