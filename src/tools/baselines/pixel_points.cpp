#include "pixel_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace fiimap::bench {
namespace {

/// Keeps an end on the box's face inside the box.
constexpr double kInside = 1e-6;  // voxels

/// Depth in metres; NaN where nothing was measured.
double depthAt(const std::uint8_t* row, int u, const DepthImage& image, double depth_scale) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  if (image.format == DepthImage::Format::kFloat32) {
    float depth;
    std::memcpy(&depth, row + u * sizeof(depth), sizeof(depth));
    return depth > 0.0f ? depth : kNothing;
  }
  constexpr std::uint16_t kSaturated = std::numeric_limits<std::uint16_t>::max();
  std::uint16_t pixel;
  std::memcpy(&pixel, row + u * sizeof(pixel), sizeof(pixel));
  return pixel == 0 || pixel == kSaturated ? kNothing : pixel * depth_scale;
}

void addPoint(double depth, const Eigen::Vector3d& unit_depth_ray_C, const MapperConfig& config,
              const Eigen::Isometry3d& T_W_C, std::vector<PixelPoint>* points) {
  const double ray_length = unit_depth_ray_C.norm();
  ReadingPolicy policy = config.beyond_max_depth;
  if (std::isnan(depth)) {
    policy = config.invalid_depth;
  } else if (std::isinf(depth)) {
    policy = config.infinite_depth;
  } else if (depth < config.min_depth || depth * ray_length < config.min_ray_length) {
    return;
  } else if (depth <= config.max_depth && depth * ray_length <= config.max_ray_length) {
    points->push_back({T_W_C * (unit_depth_ray_C * depth), true});
    return;
  }
  if (policy == ReadingPolicy::kIgnore) return;
  const double longest = std::min(config.max_depth, config.max_ray_length / ray_length);
  points->push_back({T_W_C * (unit_depth_ray_C * longest), false});
}

void projectImage(const Frame& frame, const MapperConfig& config, std::vector<PixelPoint>* points) {
  const DepthImage& image = frame.image.view;
  const PinholeIntrinsics& k = frame.intrinsics;
  const Eigen::Vector2i step = DepthProjector(config).pixelStep(k);
  const int margin = config.border_margin;
  for (int v = margin; v < image.height - margin; v += step.y()) {
    const auto* row = static_cast<const std::uint8_t*>(image.data) + v * image.row_bytes;
    for (int u = margin; u < image.width - margin; u += step.x()) {
      const Eigen::Vector3d ray_C((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1.0);
      addPoint(depthAt(row, u, image, config.depth_scale), ray_C, config, frame.pose.T_W_S, points);
    }
  }
}

void projectCloud(const Frame& frame, const MapperConfig& config, std::vector<PixelPoint>* points) {
  for (const Eigen::Vector3f& point_S : frame.points->points) {
    const Eigen::Vector3d ray_S = point_S.cast<double>();
    const double length = ray_S.norm();
    if (!std::isfinite(length) || length < config.min_ray_length) continue;
    if (length <= config.max_ray_length) {
      points->push_back({frame.pose.T_W_S * ray_S, true});
    } else if (config.beyond_max_depth == ReadingPolicy::kFree) {
      points->push_back({frame.pose.T_W_S * (ray_S * (config.max_ray_length / length)), false});
    }
  }
}

}  // namespace

void projectPixels(const Frame& frame, const MapperConfig& config,
                   std::vector<PixelPoint>* points) {
  points->clear();
  if (frame.points) {
    projectCloud(frame, config, points);
  } else {
    projectImage(frame, config, points);
  }
}

bool clipToBox(const Eigen::Vector3d& origin, const VoxelBox& box, Eigen::Vector3d* end,
               bool* is_return) {
  const Eigen::Vector3d low = box.min.cast<double>();
  const Eigen::Vector3d high = box.max.cast<double>().array() - kInside;
  if ((origin.array() < low.array()).any() || (origin.array() > high.array()).any()) return false;
  double share = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = (*end)[axis] - origin[axis];
    if ((*end)[axis] < low[axis]) share = std::min(share, (low[axis] - origin[axis]) / length);
    if ((*end)[axis] > high[axis]) share = std::min(share, (high[axis] - origin[axis]) / length);
  }
  if (share == 1.0) return true;
  *end = (origin + share * (*end - origin)).cwiseMax(low).cwiseMin(high);
  *is_return = false;
  return true;
}

}  // namespace fiimap::bench
