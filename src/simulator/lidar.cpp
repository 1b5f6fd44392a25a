#include "lidar.h"

#include <cmath>

#include "random.h"

namespace fiimap::sim {
namespace {

constexpr std::uint64_t kScanStream = std::uint64_t{1}
                                      << 40;  // of random numbers: the first scan's
constexpr double kNearest = 0.1;              // m

Eigen::Vector3f directionOf(double azimuth, double elevation) {
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
      .cast<float>();
}

/// Ring by ring.
std::vector<Eigen::Vector3f> ringDirections(const LidarConfig& config) {
  std::vector<Eigen::Vector3f> directions;
  const double fov = config.lidar_fov_up + config.lidar_fov_down;
  for (int ring = 0; ring < config.lidar_rings; ++ring) {
    const double share = config.lidar_rings > 1 ? ring / (config.lidar_rings - 1.0) : 0.5;
    for (int column = 0; column < config.lidar_columns; ++column) {
      directions.push_back(directionOf(2.0 * M_PI * column / config.lidar_columns,
                                       share * fov - config.lidar_fov_down));
    }
  }
  return directions;
}

/// The next points of a sequence that fills azimuth and elevation evenly and never repeats: shares
/// of a turn that belong to the plastic number, the root of x^3 = x + 1 (Roberts 2018).
std::vector<Eigen::Vector3f> livoxDirections(const LidarConfig& config, std::uint64_t number) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto count = static_cast<std::uint64_t>(config.lidar_rings * config.lidar_columns);
  const double fov = config.lidar_fov_up + config.lidar_fov_down;
  std::vector<Eigen::Vector3f> directions;
  for (std::uint64_t i = number * count; i < (number + 1) * count; ++i) {
    const double turn = std::fmod(static_cast<double>(i) / kPlastic, 1.0);
    const double share = std::fmod(static_cast<double>(i) / (kPlastic * kPlastic), 1.0);
    directions.push_back(directionOf(2.0 * M_PI * turn, share * fov - config.lidar_fov_down));
  }
  return directions;
}

}  // namespace

Eigen::Isometry3d LidarConfig::T_B_L() const {
  return Eigen::Isometry3d(Eigen::Translation3d(lidar_x, lidar_y, lidar_z));
}

Lidar::Lidar(const LidarConfig& config, std::uint64_t seed)
    : config_(config), seed_(seed), rays_(ringDirections(config)) {}

std::vector<Eigen::Vector3f> Lidar::scan(const RayScene& scene, const Eigen::Isometry3d& T_W_L,
                                         std::uint64_t number) {
  if (config_.lidar == LidarKind::kLivox) rays_ = RayBundle(livoxDirections(config_, number));
  const RayHits& hits = rays_.cast(scene, T_W_L, config_.lidar_range, false);
  Random random(seed_, kScanStream + number);
  std::vector<Eigen::Vector3f> points_L;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (!std::isfinite(hits.lengths[i]) || hits.lengths[i] < kNearest) continue;
    const float error = static_cast<float>(config_.lidar_noise) * random.normal();
    points_L.emplace_back((hits.lengths[i] + error) * rays_.directions()[i]);
  }
  return points_L;
}

}  // namespace fiimap::sim
