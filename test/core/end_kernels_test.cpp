#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels_fixture.h"

namespace fiimap {
namespace {

using EndKernels = test::KernelsTest;

TEST_P(EndKernels, ListEnds) {
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

TEST_P(EndKernels, SelectEnds) {
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

TEST_P(EndKernels, RoundRays) {
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

INSTANTIATE_TEST_SUITE_P(InstructionSets, EndKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

}  // namespace
}  // namespace fiimap
