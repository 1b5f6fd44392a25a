#include "fiimap/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/bit_column.h"
#include "oracle.h"

/// Every instruction set that this machine has computes the same bits as plain C++. That plain C++
/// is right, the tests of the classes that use it show.
namespace fiimap {

void PrintTo(const Kernels* kernels, std::ostream* out) { *out << kernels->name; }

namespace {

constexpr int kRounds = 300;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class KernelsTest : public ::testing::TestWithParam<const Kernels*> {
 protected:
  float uniform(double low, double high) {
    return static_cast<float>(test::uniformReal(random_, low, high));
  }
  std::uint64_t randomWord() {
    const auto half = [&] { return static_cast<std::uint64_t>(random_()); };
    switch (test::uniformInt(random_, 0, 3)) {
      case 0:
        return 0;
      case 1:
        return ~std::uint64_t{0};
      default:
        return half() << 32 | half();
    }
  }

  const Kernels& tested_ = *GetParam();
  const Kernels& plain_ = plainKernels();
  test::Random random_{81};
};

bool sameFloat(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

TEST_P(KernelsTest, ReadDepths) {
  for (int round = 0; round < kRounds; ++round) {
    const int step = test::uniformInt(random_, 1, 5);
    const int samples = test::uniformInt(random_, 0, 70);
    const int shift = test::uniformInt(random_, 0, 1);  // rows need not be aligned
    // No byte after the last sample, so that a sanitizer sees who reads too far.
    std::vector<std::uint8_t> pixels(shift + (samples > 0 ? 2 * (step * (samples - 1) + 1) : 0));
    for (std::uint8_t& byte : pixels) {
      byte = test::chance(random_, 0.3) ? 0xff : test::chance(random_, 0.3) ? 0 : random_();
    }
    std::vector<float> expected(samples), depth(samples);
    plain_.readDepths(pixels.data() + shift, step, samples, 0.001f, expected.data());
    tested_.readDepths(pixels.data() + shift, step, samples, 0.001f, depth.data());
    for (int i = 0; i < samples; ++i) ASSERT_TRUE(sameFloat(depth[i], expected[i])) << i;
  }
}

TEST_P(KernelsTest, ProjectRow) {
  for (int round = 0; round < kRounds; ++round) {
    const int samples = test::uniformInt(random_, 0, 100);
    const int room = samples + kVectorRoom;
    std::vector<float> depth(room), ray_x(room), ray_y(room), ray_z(room), length_2(room);
    const double odd_share = test::uniformInt(random_, 0, 2) * 0.3;
    for (int i = 0; i < samples; ++i) {
      constexpr float kOdd[] = {kNan, 0.1f, 20.0f, std::numeric_limits<float>::infinity()};
      depth[i] = test::chance(random_, odd_share) ? kOdd[test::uniformInt(random_, 0, 3)]
                                                  : uniform(0.5, 4.0);
      ray_x[i] = uniform(-1.0, 1.0);
      ray_y[i] = uniform(-1.0, 1.0);
      ray_z[i] = uniform(-1.0, 1.0);
      length_2[i] = uniform(0.0, 1.0);
    }
    const DepthRow row{
        depth.data(), samples, ray_x.data(), ray_y.data(), ray_z.data(), length_2.data(), 0.25f,
        -0.5f,        1.0f,    1.25f,        0.3f,         8.0f,         0.09f,           30.0f};
    for (const bool list_invalid : {false, true}) {
      const auto run = [&](const Kernels& kernels) {
        std::vector<float> points[3];
        for (auto& axis : points) axis.resize(room);
        std::vector<std::int32_t> others(room);
        const RowCount count = kernels.projectRow(
            row, list_invalid, points[0].data(), points[1].data(), points[2].data(), others.data());
        for (auto& axis : points) axis.resize(count.returns);
        others.resize(count.others);
        return std::make_tuple(points[0], points[1], points[2], others);
      };
      ASSERT_EQ(run(tested_), run(plain_)) << "samples " << samples;
    }
  }
}

TEST_P(KernelsTest, ListEnds) {
  for (int round = 0; round < kRounds; ++round) {
    const int count = test::uniformInt(random_, 0, 100);
    std::vector<float> offset[3];
    const float spread = test::chance(random_, 0.5) ? 0.05f : 2.0f;
    for (auto& axis : offset) {
      axis.resize(count + kVectorRoom);
      for (int i = 0; i < count; ++i)
        axis[i] = test::chance(random_, 0.05) ? 0.0f : uniform(-spread, spread);
    }
    const EndPoints points{offset[0].data(),       offset[1].data(), offset[2].data(), count, 10.0f,
                           {10.25f, 5.5f, 15.75f}, {20, 30, 100}};
    const auto run = [&](const Kernels& kernels) {
      RayEnds ends;
      kernels.listEnds(points, &ends);
      std::vector<std::array<int, 3>> end_of;
      std::array<int, 4> bounds{ends.low[0], ends.low[1], ends.high[0], ends.high[1]};
      for (int k = 0; k < ends.size; ++k) {
        EXPECT_EQ(ends.first[k], static_cast<int>(end_of.size()));
        end_of.resize(ends.first[k + 1], {ends.x[k], ends.y[k], ends.z[k]});
      }
      EXPECT_EQ(static_cast<int>(end_of.size()), count);
      EXPECT_TRUE(spread > 0.1f || count < 50 || ends.size < count) << "leaves something out";
      return std::make_pair(end_of, bounds);
    };
    ASSERT_EQ(run(tested_), run(plain_));
  }
}

TEST_P(KernelsTest, SelectEnds) {
  for (int round = 0; round < kRounds; ++round) {
    const VoxelIndex size(test::uniformInt(random_, 1, 5), test::uniformInt(random_, 1, 7),
                          test::uniformInt(random_, 1, 150));
    const int words = (size.z() + kWordBits - 1) / kWordBits;
    std::vector<std::uint64_t> plane(size.x() * size.y() * words);
    for (std::uint64_t& word : plane) word = randomWord();
    const int count = test::uniformInt(random_, 0, 60);
    RayEnds ends;
    ends.begin(count);
    for (int k = 0; k < count; ++k) {
      ends.x[k] = test::uniformInt(random_, 0, size.x() - 1);
      ends.y[k] = test::uniformInt(random_, 0, size.y() - 1);
      ends.z[k] = test::uniformInt(random_, 0, size.z() - 1);
      if (test::chance(random_, 0.2)) ends.z[k] += RayEnds::kLeavesBox;
    }
    const int first = test::uniformInt(random_, 0, count);
    for (const bool value : {false, true}) {
      const auto run = [&](const Kernels& kernels) {
        std::vector<std::int32_t> listed(count + kVectorRoom);
        const VoxelBits bits{plane.data(), size.y(), words};
        listed.resize(kernels.selectEnds(ends, first, count, bits, value, listed.data()));
        return listed;
      };
      ASSERT_EQ(run(tested_), run(plain_));
    }
  }
}

TEST_P(KernelsTest, RoundRays) {
  for (int round = 0; round < kRounds; ++round) {
    const int count = test::uniformInt(random_, 0, 60);
    RayEnds ends;
    ends.begin(count);
    std::vector<std::int32_t> index(count + kVectorRoom);
    for (int i = 0; i < count; ++i) {
      ends.x[i] = test::uniformInt(random_, 0, 20);
      ends.y[i] = test::uniformInt(random_, 0, 30);
      ends.z[i] = test::uniformInt(random_, 0, 40);
      if (test::chance(random_, 0.3)) ends.z[i] += RayEnds::kLeavesBox;
      index[i] = test::uniformInt(random_, 0, count - 1);
    }
    const float cut = test::chance(random_, 0.5) ? 0.0f : 2.25f;
    const bool at_center = test::chance(random_, 0.3);
    const DirectionCube cube{test::uniformInt(random_, 10, 31),
                             {10.25f, at_center ? 14.5f : 3.75f, at_center ? 20.5f : 15.0f}};
    const auto run = [&](const Kernels& kernels) {
      CubeRays rays;
      kernels.roundRays(cube, ends, index.data(), count, cut, &rays);
      rays.slice.resize(count);
      rays.cell.resize(count);
      // A ray of no length has no reach.
      for (int i = 0; i < count; ++i) {
        if (rays.slice[i] == CubeRays::kStraight) rays.reach[i] = 0.0f;
      }
      rays.reach.resize(count);
      return std::make_tuple(rays.slice, rays.cell, rays.reach);
    };
    ASSERT_EQ(run(tested_), run(plain_));
  }
}

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

TEST_P(KernelsTest, Walk) {
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

TEST_P(KernelsTest, FreeRuns) {
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

TEST_P(KernelsTest, Observe) {
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

/// Some columns of a strip, at least one.
StripSpan randomSpan(test::Random& random) {
  const int first = test::uniformInt(random, 0, Strip::kColumns - 1);
  return {first, test::uniformInt(random, first + 1, Strip::kColumns)};
}

TEST_P(KernelsTest, Widen) {
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

TEST_P(KernelsTest, Dilate) {
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

TEST_P(KernelsTest, Replace) {
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

INSTANTIATE_TEST_SUITE_P(InstructionSets, KernelsTest, ::testing::ValuesIn(availableKernels()),
                         [](const auto& info) { return std::string(info.param->name); });

TEST(KernelsTest, PlainOnesAreTheLast) {
  ASSERT_FALSE(availableKernels().empty());
  EXPECT_EQ(availableKernels().back(), &plainKernels());
}

}  // namespace
}  // namespace fiimap
