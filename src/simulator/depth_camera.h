#pragma once

#include <vector>

#include "ray_bundle.h"

namespace fiimap::sim {

/// Pinhole without distortion; names are the parameter names.
struct CameraConfig {
  int image_width = 640;
  int image_height = 480;
  double horizontal_fov = 1.2217;  // rad
  double camera_rate = 30.0;
  double camera_x = 0.1;
  double camera_y = 0.0;
  double camera_z = 0.0;
  double camera_pitch = 0.0;
  double min_range = 0.2;
  double max_range = 20.0;

  /// Focal length of both axes, pixels.
  double focalLength() const;
  /// Principal point, pixels from the middle of the first pixel.
  Eigen::Vector2d center() const;
  /// Optical frame (z forward, x right, y down) to body (x forward, y left, z up).
  Eigen::Isometry3d T_B_C() const;
};

/// Row by row. Infinity where nothing was met, or nothing that is anywhere near the camera's range.
struct DepthFrame {
  int width = 0;
  int height = 0;
  std::vector<float> depth;          ///< along the optical axis, m
  std::vector<float> cos_incidence;  ///< of ray and surface; empty if not asked for

  float* row(int v) { return depth.data() + static_cast<std::size_t>(v) * width; }
};

/// Renders exact depth. Not thread-safe.
class DepthCamera {
 public:
  explicit DepthCamera(const CameraConfig& config);

  /// \param T_W_C optical frame to world.
  const DepthFrame& render(const RayScene& scene, const Eigen::Isometry3d& T_W_C,
                           bool with_incidence);

 private:
  std::vector<std::size_t> pixels_;  // index of each ray's pixel
  RayBundle rays_;
  double longest_;  // m
  DepthFrame frame_;
};

}  // namespace fiimap::sim
