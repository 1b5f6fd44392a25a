#include "depth_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace fiimap::sim {
namespace {

constexpr double kFocalLength = 400.0;  // pixels
constexpr float kMissing = std::numeric_limits<float>::infinity();

DepthFrame wallAt(float depth, int width = 300, int height = 300) {
  DepthFrame frame;
  frame.width = width;
  frame.height = height;
  frame.depth.assign(static_cast<std::size_t>(width) * height, depth);
  frame.cos_incidence.assign(frame.depth.size(), 1.0f);
  return frame;
}

/// Errors of all kinds off.
NoiseConfig noNoise() {
  NoiseConfig config;
  config.depth_noise = true;
  config.disparity_step = 1e-6;
  config.disparity_noise = 0.0;
  config.dropout = 0.0;
  config.max_incidence = M_PI / 2;
  return config;
}

double disparityOf(const NoiseConfig& config, float depth) {
  return kFocalLength * config.baseline / depth;
}

TEST(DepthNoiseTest, DisparityHasTheNoiseThatWasAskedFor) {
  NoiseConfig config = noNoise();
  config.disparity_noise = 0.1;
  for (const float depth : {1.0f, 4.0f}) {
    DepthFrame frame = wallAt(depth);
    DepthNoise(config, kFocalLength, 1).apply(7, &frame);
    double sum = 0.0, squares = 0.0;
    for (const float d : frame.depth) {
      const double error = disparityOf(config, d) - disparityOf(config, depth);
      sum += error;
      squares += error * error;
    }
    const auto count = static_cast<double>(frame.depth.size());
    // Standard errors of 90000 samples: 0.1 / 300 and 0.1 / 424.
    EXPECT_NEAR(sum / count, 0.0, 5 * 0.1 / 300);
    EXPECT_NEAR(std::sqrt(squares / count), 0.1, 5 * 0.1 / 424);
  }
}

TEST(DepthNoiseTest, DepthErrorGrowsWithTheSquareOfTheDistance) {
  NoiseConfig config = noNoise();
  config.disparity_noise = 0.05;
  const auto deviation = [&](float depth) {
    DepthFrame frame = wallAt(depth);
    DepthNoise(config, kFocalLength, 1).apply(7, &frame);
    double squares = 0.0;
    for (const float d : frame.depth) squares += (d - depth) * (d - depth);
    return std::sqrt(squares / static_cast<double>(frame.depth.size()));
  };
  const double expected_at_1 = 0.05 / (kFocalLength * config.baseline);
  EXPECT_NEAR(deviation(1.0f), expected_at_1, 0.03 * expected_at_1);
  EXPECT_NEAR(deviation(2.0f), 4 * expected_at_1, 0.03 * 4 * expected_at_1);
  EXPECT_NEAR(deviation(4.0f), 16 * expected_at_1, 0.03 * 16 * expected_at_1);
}

TEST(DepthNoiseTest, DisparityComesInSteps) {
  NoiseConfig config = noNoise();
  config.disparity_step = 0.125;
  config.disparity_noise = 0.5;
  DepthFrame frame = wallAt(3.0f);
  DepthNoise(config, kFocalLength, 1).apply(7, &frame);
  for (const float d : frame.depth) {
    const double steps = disparityOf(config, d) / config.disparity_step;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(DepthNoiseTest, NearEdgesThrowShadowsToTheirLeftOnly) {
  const NoiseConfig config = noNoise();
  constexpr int kLeft = 100, kRight = 150;
  constexpr float kNear = 1.0f, kFar = 4.0f;
  DepthFrame frame = wallAt(kFar, 300, 1);
  for (int u = kLeft; u < kRight; ++u) frame.depth[static_cast<std::size_t>(u)] = kNear;
  DepthNoise(config, kFocalLength, 1).apply(7, &frame);
  // What the near edge moves farther than the background, 20 - 5 pixels.
  const auto width = static_cast<int>(disparityOf(config, kNear) - disparityOf(config, kFar));
  for (int u = 0; u < 300; ++u) {
    const bool hidden = u >= kLeft - width && u < kLeft;
    EXPECT_EQ(frame.depth[static_cast<std::size_t>(u)] == kMissing, hidden) << u;
  }
}

TEST(DepthNoiseTest, FlatAnglesAndSomePixelsAreMissing) {
  NoiseConfig config = noNoise();
  config.max_incidence = 1.2;
  DepthFrame frame = wallAt(2.0f);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    frame.cos_incidence[i] = static_cast<float>(std::cos(i % 2 ? 1.19 : 1.21));
  }
  DepthNoise(config, kFocalLength, 1).apply(7, &frame);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    ASSERT_EQ(frame.depth[i] == kMissing, i % 2 == 0) << i;
  }

  config.dropout = 0.1;
  frame = wallAt(2.0f);
  DepthNoise(config, kFocalLength, 1).apply(7, &frame);
  const auto missing = std::count(frame.depth.begin(), frame.depth.end(), kMissing);
  EXPECT_NEAR(static_cast<double>(missing) / 90000.0, 0.1, 5 * 0.3 / 300);
}

TEST(DepthNoiseTest, DependsOnSeedAndNumberAlone) {
  NoiseConfig config;
  const auto noisy = [&](std::uint64_t seed, std::uint64_t number) {
    DepthFrame frame = wallAt(3.0f, 40, 30);
    DepthNoise(config, kFocalLength, seed).apply(number, &frame);
    return frame.depth;
  };
  EXPECT_EQ(noisy(1, 5), noisy(1, 5));
  EXPECT_NE(noisy(1, 5), noisy(1, 6));
  EXPECT_NE(noisy(1, 5), noisy(2, 5));
}

}  // namespace
}  // namespace fiimap::sim
