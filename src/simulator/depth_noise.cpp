#include "depth_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "random.h"

namespace fiimap::sim {
namespace {

constexpr float kMissing = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kFrameStream = 1000;  // of random numbers: the first of the frames'

}  // namespace

DepthNoise::DepthNoise(const NoiseConfig& config, double focal_length, std::uint64_t seed)
    : config_(config),
      depth_times_disparity_(static_cast<float>(focal_length * config.baseline)),
      min_cos_incidence_(static_cast<float>(std::cos(config.max_incidence))),
      seed_(seed) {}

void DepthNoise::apply(std::uint64_t number, DepthFrame* frame) const {
  Random random(seed_, kFrameStream + number);
  const auto step = static_cast<float>(config_.disparity_step);
  const auto noise = static_cast<float>(config_.disparity_noise);
  std::vector<bool> hidden(static_cast<std::size_t>(frame->width));
  for (int v = 0; v < frame->height; ++v) {
    float* row = frame->row(v);
    const float* cos_incidence =
        frame->cos_incidence.data() + static_cast<std::size_t>(v) * frame->width;
    hideShadows(row, frame->width, &hidden);
    for (int u = 0; u < frame->width; ++u) {
      if (row[u] == kMissing) continue;
      const bool missing = hidden[static_cast<std::size_t>(u)] ||
                           cos_incidence[u] < min_cos_incidence_ || random.chance(config_.dropout);
      const float disparity = depth_times_disparity_ / row[u] + noise * random.normal();
      const auto steps = static_cast<std::int64_t>(disparity / step + 0.5f);
      const float quantised = static_cast<float>(steps) * step;
      row[u] = missing || quantised <= 0.0f ? kMissing : depth_times_disparity_ / quantised;
    }
  }
}

/// A pixel u of disparity d lies at u - d in the other camera's row. Of all pixels that fall on the
/// same place there the nearest is seen: one to the right with a larger disparity.
void DepthNoise::hideShadows(const float* row, int width, std::vector<bool>* hidden) const {
  float leftmost = std::numeric_limits<float>::infinity();
  for (int u = width - 1; u >= 0; --u) {
    const float other = static_cast<float>(u) - depth_times_disparity_ / row[u];
    (*hidden)[static_cast<std::size_t>(u)] = other >= leftmost;
    leftmost = std::min(leftmost, other);
  }
}

std::vector<std::uint16_t> toMillimetres(const DepthFrame& frame, double min_range,
                                         double max_range) {
  constexpr float kMillimetres = 1000.0f;
  const auto nearest = static_cast<float>(min_range), farthest = static_cast<float>(max_range);
  std::vector<std::uint16_t> image(frame.depth.size());
  std::transform(frame.depth.begin(), frame.depth.end(), image.begin(), [&](float depth) {
    const bool in_range = depth >= nearest && depth <= farthest;
    return static_cast<std::uint16_t>(in_range ? depth * kMillimetres + 0.5f : 0.0f);
  });
  return image;
}

}  // namespace fiimap::sim
