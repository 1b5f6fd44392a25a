#include "depth_camera.h"

#include <algorithm>
#include <cmath>

namespace fiimap::sim {
namespace {

// Pixels are traced in square tiles, whose rays stay close together.
constexpr int kTile = 4;
// Rays end a little beyond the range, because noise may bring what lies there into it.
constexpr double kRangeMargin = 1.25;

/// Pixel indices tile by tile.
std::vector<std::size_t> pixelsInTiles(int width, int height) {
  std::vector<std::size_t> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * height);
  for (int v0 = 0; v0 < height; v0 += kTile) {
    for (int u0 = 0; u0 < width; u0 += kTile) {
      for (int v = v0; v < std::min(v0 + kTile, height); ++v) {
        for (int u = u0; u < std::min(u0 + kTile, width); ++u) {
          pixels.push_back(static_cast<std::size_t>(v) * width + u);
        }
      }
    }
  }
  return pixels;
}

/// Rays of length 1 along the optical axis, so that their lengths are depths.
std::vector<Eigen::Vector3f> pixelRays(const CameraConfig& config,
                                       const std::vector<std::size_t>& pixels) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(pixels.size());
  const auto width = static_cast<std::size_t>(config.image_width);
  for (const std::size_t pixel : pixels) {
    const Eigen::Vector2d uv(static_cast<double>(pixel % width),
                             static_cast<double>(pixel / width));
    const Eigen::Vector2d xy = (uv - config.center()) / config.focalLength();
    rays.emplace_back(static_cast<float>(xy.x()), static_cast<float>(xy.y()), 1.0f);
  }
  return rays;
}

}  // namespace

double CameraConfig::focalLength() const {
  return image_width / 2.0 / std::tan(horizontal_fov / 2.0);
}

Eigen::Vector2d CameraConfig::center() const {
  return {(image_width - 1) / 2.0, (image_height - 1) / 2.0};
}

Eigen::Isometry3d CameraConfig::T_B_C() const {
  Eigen::Matrix3d R_B_C;  // columns: the optical frame's axes in a body that looks straight ahead
  R_B_C << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T_B_C = Eigen::Isometry3d::Identity();
  T_B_C.linear() = Eigen::AngleAxisd(camera_pitch, Eigen::Vector3d::UnitY()) * R_B_C;
  T_B_C.translation() = Eigen::Vector3d(camera_x, camera_y, camera_z);
  return T_B_C;
}

DepthCamera::DepthCamera(const CameraConfig& config)
    : pixels_(pixelsInTiles(config.image_width, config.image_height)),
      rays_(pixelRays(config, pixels_)),
      longest_(kRangeMargin * config.max_range) {
  frame_.width = config.image_width;
  frame_.height = config.image_height;
  frame_.depth.resize(pixels_.size());
}

const DepthFrame& DepthCamera::render(const RayScene& scene, const Eigen::Isometry3d& T_W_C,
                                      bool with_incidence) {
  const RayHits& hits = rays_.cast(scene, T_W_C, longest_, with_incidence);
  for (std::size_t i = 0; i < pixels_.size(); ++i) frame_.depth[pixels_[i]] = hits.lengths[i];
  frame_.cos_incidence.resize(hits.cos_incidence.size());
  for (std::size_t i = 0; i < hits.cos_incidence.size(); ++i) {
    frame_.cos_incidence[pixels_[i]] = hits.cos_incidence[i];
  }
  return frame_;
}

}  // namespace fiimap::sim
