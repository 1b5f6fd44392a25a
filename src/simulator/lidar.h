#pragma once

#include <cstdint>
#include <vector>

#include "ray_bundle.h"

namespace fiimap::sim {

enum class LidarKind { kNone, kSpinning, kLivox };

/// Names are the parameter names.
struct LidarConfig {
  LidarKind lidar = LidarKind::kNone;
  double lidar_rate = 10.0;
  int lidar_rings = 16;
  int lidar_columns = 900;
  double lidar_fov_down = 0.2618;
  double lidar_fov_up = 0.2618;
  double lidar_range = 50.0;
  double lidar_noise = 0.0;
  double lidar_x = 0.0;
  double lidar_y = 0.0;
  double lidar_z = 0.1;

  /// LiDAR (axes as the body's) to body.
  Eigen::Isometry3d T_B_L() const;
};

/// A LiDAR that turns around the vertical axis: rings at fixed elevations, or like those of Livox a
/// pattern that never repeats, of as many points. All rays of a scan start at one moment, as in
/// clouds whose motion was corrected by the driver. Not thread-safe.
class Lidar {
 public:
  Lidar(const LidarConfig& config, std::uint64_t seed);

  /// Points that the rays of a scan met, in the LiDAR's frame, m.
  /// \param number of the scan; \param T_W_L LiDAR to world.
  std::vector<Eigen::Vector3f> scan(const RayScene& scene, const Eigen::Isometry3d& T_W_L,
                                    std::uint64_t number);

 private:
  LidarConfig config_;
  std::uint64_t seed_;
  RayBundle rays_;
};

}  // namespace fiimap::sim
