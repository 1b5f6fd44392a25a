#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "kernels_fixture.h"

namespace fiimap {
namespace {

using DepthKernels = test::KernelsTest;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool sameFloat(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

TEST_P(DepthKernels, ReadDepths) {
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

TEST_P(DepthKernels, ProjectRow) {
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

INSTANTIATE_TEST_SUITE_P(InstructionSets, DepthKernels, ::testing::ValuesIn(availableKernels()),
                         test::nameOfKernels);

TEST(Kernels, PlainOnesAreTheLast) {
  ASSERT_FALSE(availableKernels().empty());
  EXPECT_EQ(availableKernels().back(), &plainKernels());
}

}  // namespace
}  // namespace fiimap
