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
constexpr int kCacheLine = 64;  // bytes

/// Images come from another thread or the network, and rows that are left out hide from the
/// processor which row is next: it has to be told, in time.
void prefetchRow(const DepthImage& image, int v) {
  const auto* const row = static_cast<const std::uint8_t*>(image.data) + v * image.row_bytes;
  for (std::size_t byte = 0; byte < image.row_bytes; byte += kCacheLine) {
    __builtin_prefetch(row + byte);
  }
}

/// Larger than any image, and sums with pixel coordinates do not overflow.
constexpr double kMaxStep = 1 << 20;

/// Samples of an axis of `size` pixels that is sampled from `margin` to `size - margin`.
int sampleCount(int size, int margin, int step) {
  const int last = size - margin - 1;
  return last < margin ? 0 : (last - margin) / step + 1;
}

}  // namespace

DepthProjector::DepthProjector(const MapperConfig& config)
    : config_(config),
      limits_{static_cast<float>(config.min_depth), static_cast<float>(config.max_depth),
              static_cast<float>(config.min_ray_length), static_cast<float>(config.max_ray_length),
              static_cast<float>(config.ray_end_cut * config.resolution)},
      kernels_(kernels()) {}

void DepthProjector::RayParts::resize(int new_size) {
  size = new_size;
  for (auto* part : {&x, &y, &z, &length_2}) part->resize(size + kVectorRoom);
}

void DepthProjector::RayParts::set(int i, const Eigen::Vector3d& ray, double length_2_part) {
  x[i] = static_cast<float>(ray.x());
  y[i] = static_cast<float>(ray.y());
  z[i] = static_cast<float>(ray.z());
  length_2[i] = static_cast<float>(length_2_part);
}

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

  const Eigen::Vector2i step = pixelStep(intrinsics);
  scan->returns_per_steradian = intrinsics.fx * intrinsics.fy / step.cast<double>().prod();  // on the axis
  const Eigen::Matrix3d R_W_C = T_W_C.linear();
  const int margin = config_.border_margin;
  ray_of_u_.resize(sampleCount(image.width, margin, step.x()));
  for (int i = 0; i < ray_of_u_.size; ++i) {
    const double u = margin + static_cast<double>(i) * step.x();
    const double slope = (u - intrinsics.cx) / intrinsics.fx;
    ray_of_u_.set(i, R_W_C.col(0) * slope, slope * slope);
  }
  ray_of_v_.resize(sampleCount(image.height, margin, step.y()));
  for (int i = 0; i < ray_of_v_.size; ++i) {
    const double v = margin + static_cast<double>(i) * step.y();
    const double slope = (v - intrinsics.cy) / intrinsics.fy;
    ray_of_v_.set(i, R_W_C.col(1) * slope + R_W_C.col(2), slope * slope + 1.0);
  }
  return projectRows(image, step, scan);
}

ReadingCount DepthProjector::projectRows(const DepthImage& image, const Eigen::Vector2i& step,
                                         RangeData* scan) {
  const int samples = ray_of_u_.size;
  depths_.resize(samples + kVectorRoom);
  others_.resize(samples + kVectorRoom);
  const bool list_invalid = config_.invalid_depth == ReadingPolicy::kFree;
  DepthRow row;
  row.depth = depths_.data();
  row.samples = samples;
  row.ray_x = ray_of_u_.x.data();
  row.ray_y = ray_of_u_.y.data();
  row.ray_z = ray_of_u_.z.data();
  row.length_2 = ray_of_u_.length_2.data();
  row.min_depth = limits_.min_depth;
  row.max_depth = limits_.max_depth;
  row.min_length_2 = limits_.min_length * limits_.min_length;
  row.max_length_2 = limits_.max_length * limits_.max_length;

  ReadingCount count;
  PointList& returns = scan->returns;
  for (int i = 0; i < ray_of_v_.size; ++i) {
    if (i + 1 < ray_of_v_.size) prefetchRow(image, config_.border_margin + (i + 1) * step.y());
    readDepths(image, config_.border_margin + i * step.y(), step.x());
    row.row_x = ray_of_v_.x[i];
    row.row_y = ray_of_v_.y[i];
    row.row_z = ray_of_v_.z[i];
    row.row_length_2 = ray_of_v_.length_2[i];

    const std::size_t first = returns.size();
    returns.resize(first + samples);
    const RowCount split =
        kernels_.projectRow(row, list_invalid, returns.x() + first, returns.y() + first,
                            returns.z() + first, others_.data());
    returns.resize(first + split.returns);
    count.total += samples;
    count.returns += split.returns;
    if (!list_invalid) count.invalid += samples - split.returns - split.others;
    for (int k = 0; k < split.others; ++k) {
      const int j = others_[k];
      const Eigen::Vector3f ray(row.ray_x[j] + row.row_x, row.ray_y[j] + row.row_y,
                                row.ray_z[j] + row.row_z);
      addOther(depths_[j], ray, scan, &count);
    }
  }
  return count;
}

/// Fills depths_ with the samples of row v, NaN where no distance was measured.
void DepthProjector::readDepths(const DepthImage& image, int v, int step) {
  const int samples = ray_of_u_.size;
  const auto* const row = static_cast<const std::uint8_t*>(image.data) + v * image.row_bytes;
  if (image.format == DepthImage::Format::kUint16) {
    kernels_.readDepths(row + config_.border_margin * sizeof(std::uint16_t), step, samples,
                        static_cast<float>(config_.depth_scale), depths_.data());
    return;
  }
  for (int i = 0; i < samples; ++i) {
    float depth;  // rows need not be aligned
    std::memcpy(&depth, row + (config_.border_margin + i * step) * sizeof(depth), sizeof(depth));
    depths_[i] = depth > 0.0f ? depth : std::numeric_limits<float>::quiet_NaN();
  }
}

/// A reading that is no return.
void DepthProjector::addOther(float depth, const Eigen::Vector3f& ray, RangeData* scan,
                              ReadingCount* count) const {
  ReadingPolicy policy = config_.beyond_max_depth;
  const float ray_length = ray.norm();
  if (!std::isfinite(ray_length)) {
    // A pixel so far from the principal point in focal lengths looks nowhere.
    ++count->invalid;
    return;
  }
  if (std::isnan(depth)) {
    ++count->invalid;
    policy = config_.invalid_depth;
  } else if (std::isinf(depth)) {
    ++count->infinite;
    policy = config_.infinite_depth;
  } else if (depth <= limits_.max_depth && depth * ray_length <= limits_.max_length) {
    // Also where rounding decides: nothing is freed beyond what may have been a near obstacle.
    ++count->too_near;
    return;
  } else {
    ++count->too_far;
  }
  if (policy != ReadingPolicy::kFree) return;
  float free_depth = std::min(limits_.max_depth, limits_.max_length / ray_length);
  // What was met beyond the range is a surface, too: its rays are cut off as those of others are.
  const bool met_surface = !std::isnan(depth) && !std::isinf(depth);
  if (met_surface) free_depth = std::min(free_depth, depth - limits_.end_cut / ray_length);
  if (free_depth > 0.0f) scan->misses.push_back(ray * free_depth);
}

}  // namespace fiimap
