#include "pixel_points.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace fiimap::bench {
namespace {

/// Keeps an end on the box's face inside the box.
constexpr double kInside = 1e-6;  // voxels

void addPoint(double depth, const Eigen::Vector3d& unit_depth_ray_C, const MapperConfig& config,
              const Eigen::Isometry3d& T_W_C, std::vector<PixelPoint>* points) {
  const double ray_length = unit_depth_ray_C.norm();
  bool is_return = true;
  if (depth == 0.0) {
    if (config.invalid_depth == ReadingPolicy::kIgnore) return;
    is_return = false;
  } else if (depth < config.min_depth || depth * ray_length < config.min_ray_length) {
    return;
  } else if (depth > config.max_depth || depth * ray_length > config.max_ray_length) {
    is_return = false;
  }
  if (!is_return) depth = std::min(config.max_depth, config.max_ray_length / ray_length);
  points->push_back({T_W_C * (unit_depth_ray_C * depth), is_return});
}

}  // namespace

void projectPixels(const Frame& frame, const MapperConfig& config,
                   std::vector<PixelPoint>* points) {
  const DepthImage& image = frame.image.view;
  const PinholeIntrinsics& k = frame.intrinsics;
  if (image.format != DepthImage::Format::kUint16) {
    throw std::invalid_argument("the baselines read depth images of 16 bits only");
  }
  constexpr std::uint16_t kSaturated = std::numeric_limits<std::uint16_t>::max();
  points->clear();
  const int margin = config.border_margin;
  for (int v = margin; v < image.height - margin; v += config.pixel_step) {
    const auto* row = static_cast<const std::uint8_t*>(image.data) + v * image.row_bytes;
    for (int u = margin; u < image.width - margin; u += config.pixel_step) {
      std::uint16_t pixel;
      std::memcpy(&pixel, row + u * sizeof(pixel), sizeof(pixel));
      const double depth = pixel == kSaturated ? 0.0 : pixel * config.depth_scale;
      const Eigen::Vector3d ray_C((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1.0);
      addPoint(depth, ray_C, config, frame.pose.T_W_S, points);
    }
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
