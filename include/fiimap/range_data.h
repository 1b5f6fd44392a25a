#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace fiimap {

/// One scan in the world frame, whatever sensor it came from.
/// End points are offsets from the origin (metres, world axes), so that single precision suffices
/// however far the vehicle is from the world's origin.
struct RangeData {
  /// Position of the sensor in the world, metres.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Where rays met a surface.
  std::vector<Eigen::Vector3f> returns;
  /// Where rays that met nothing were cut off: free space up to and including this point.
  std::vector<Eigen::Vector3f> misses;

  void clear() {
    returns.clear();
    misses.clear();
  }
};

/// How many readings of a scan were of which kind, after down-sampling.
struct ReadingCount {
  std::size_t total = 0;     ///< looked at
  std::size_t returns = 0;   ///< within range
  std::size_t invalid = 0;   ///< 0, NaN, or 65535 of 16 bits
  std::size_t too_near = 0;  ///< below min_depth or min_ray_length
  std::size_t infinite = 0;  ///< +inf
  std::size_t too_far = 0;   ///< beyond max_depth or max_ray_length
};

}  // namespace fiimap
