#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "fiimap/mapper_config.h"
#include "fiimap/range_data.h"

namespace fiimap {

/// Points measured from the origin of their frame (LiDAR or organised depth cloud), metres.
/// A point that is not finite carries no distance and no direction: it is counted and left out.
struct PointScan {
  std::vector<Eigen::Vector3f> points;  ///< in any order, repeated ones too
};

/// Turns points into a scan: drops those nearer than min_ray_length, cuts rays off at
/// max_ray_length. Stateless, safe to share between threads.
class PointProjector {
 public:
  /// \param config validated.
  explicit PointProjector(const MapperConfig& config) : config_(config) {}

  /// Fills `scan` anew with the rays from the sensor's origin to its points.
  ReadingCount project(const PointScan& points, const Eigen::Isometry3d& T_W_S,
                       RangeData* scan) const;

 private:
  MapperConfig config_;
};

}  // namespace fiimap
