#include "fiimap/depth_projector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace fiimap {
namespace {

/// A step that is a whole number of pixels must stay so although the product is rounded.
constexpr double kRelativeSlack = 1e-9;
/// Larger than any image, and sums with pixel coordinates do not overflow.
constexpr double kMaxStep = 1 << 20;

/// A pixel of a row; rows need not be aligned.
template <typename Value>
Value loadPixel(const std::uint8_t* row, int u) {
  Value value;
  std::memcpy(&value, row + u * sizeof(Value), sizeof(Value));
  return value;
}

/// What a pixel says: a depth in metres, NaN for "invalid", or infinity.
struct Uint16Pixel {
  using Type = std::uint16_t;
  static float depth(Type value, float scale) {
    // 65535 is what drivers write for "saturated": no distance was measured.
    const bool valid = value != 0 && value != std::numeric_limits<Type>::max();
    return valid ? static_cast<float>(value) * scale : std::numeric_limits<float>::quiet_NaN();
  }
};

struct Float32Pixel {
  using Type = float;
  static float depth(Type value, float /*scale*/) {
    return value > 0.0f ? value : std::numeric_limits<float>::quiet_NaN();
  }
};

}  // namespace

bool PinholeIntrinsics::valid() const {
  return std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy) &&
         fx > 0.0 && fy > 0.0;
}

Eigen::Vector2i DepthProjector::pixelStep(const PinholeIntrinsics& intrinsics) const {
  if (config_.pixel_step > 0) return {config_.pixel_step, config_.pixel_step};
  const Eigen::Vector2d focal(intrinsics.fx, intrinsics.fy);
  const Eigen::Vector2d step = focal * (config_.resolution / config_.max_depth);
  return (step.array() * (1.0 + kRelativeSlack)).floor().max(1.0).min(kMaxStep).cast<int>();
}

ReadingCount DepthProjector::project(const DepthImage& image, const PinholeIntrinsics& intrinsics,
                                     const Eigen::Isometry3d& T_W_C, RangeData* scan) {
  scan->clear();
  scan->origin = T_W_C.translation();

  // The ray of pixel (u, v) at unit depth, in world axes, is the sum of a part of u and one of v.
  const Eigen::Matrix3d R_W_C = T_W_C.linear();
  ray_of_u_.resize(image.width);
  for (int u = 0; u < image.width; ++u) {
    ray_of_u_[u] = (R_W_C.col(0) * ((u - intrinsics.cx) / intrinsics.fx)).cast<float>();
  }
  ray_of_v_.resize(image.height);
  for (int v = 0; v < image.height; ++v) {
    const Eigen::Vector3d ray = R_W_C.col(1) * ((v - intrinsics.cy) / intrinsics.fy);
    ray_of_v_[v] = (ray + R_W_C.col(2)).cast<float>();
  }

  const Eigen::Vector2i step = pixelStep(intrinsics);
  return image.format == DepthImage::Format::kUint16
             ? projectPixels<Uint16Pixel>(image, step, scan)
             : projectPixels<Float32Pixel>(image, step, scan);
}

template <typename Pixel>
ReadingCount DepthProjector::projectPixels(const DepthImage& image, const Eigen::Vector2i& step,
                                           RangeData* scan) {
  const float scale = static_cast<float>(config_.depth_scale);
  ReadingCount count;
  for (int v = config_.border_margin; v < image.height - config_.border_margin; v += step.y()) {
    const auto* row = static_cast<const std::uint8_t*>(image.data) + v * image.row_bytes;
    for (int u = config_.border_margin; u < image.width - config_.border_margin; u += step.x()) {
      const float depth = Pixel::depth(loadPixel<typename Pixel::Type>(row, u), scale);
      addReading(depth, ray_of_u_[u] + ray_of_v_[v], scan, &count);
    }
  }
  return count;
}

void DepthProjector::addReading(float depth, const Eigen::Vector3f& ray, RangeData* scan,
                                ReadingCount* count) const {
  ++count->total;
  const float max_depth = static_cast<float>(config_.max_depth);
  const float max_length = static_cast<float>(config_.max_ray_length);
  ReadingPolicy policy = config_.beyond_max_depth;
  if (std::isnan(depth)) {
    ++count->invalid;
    policy = config_.invalid_depth;
  } else if (std::isinf(depth)) {
    ++count->infinite;
    policy = config_.infinite_depth;
  } else {
    const float length = depth * ray.norm();
    if (depth < static_cast<float>(config_.min_depth) ||
        length < static_cast<float>(config_.min_ray_length)) {
      ++count->too_near;
      return;
    }
    if (depth <= max_depth && length <= max_length) {
      ++count->returns;
      scan->returns.push_back(ray * depth);
      return;
    }
    ++count->too_far;
  }
  if (policy == ReadingPolicy::kFree) {
    scan->misses.push_back(ray * std::min(max_depth, max_length / ray.norm()));
  }
}

}  // namespace fiimap
