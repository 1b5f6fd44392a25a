#include "fiimap/point_projector.h"

#include <algorithm>
#include <cmath>

namespace fiimap {

ReadingCount PointProjector::project(const PointScan& points, const Eigen::Isometry3d& T_W_S,
                                     RangeData* scan) const {
  scan->clear();
  scan->origin = T_W_S.translation();
  const Eigen::Matrix3f R_W_S = T_W_S.linear().cast<float>();
  const float min_length = static_cast<float>(config_.min_ray_length);
  const float max_length = static_cast<float>(config_.max_ray_length);
  const float end_cut = static_cast<float>(config_.ray_end_cut * config_.resolution);

  ReadingCount count;
  count.total = points.points.size();
  for (const Eigen::Vector3f& point_S : points.points) {
    const float length = point_S.norm();
    if (!std::isfinite(length)) {
      ++count.invalid;
    } else if (length < min_length) {
      ++count.too_near;
    } else if (length <= max_length) {
      ++count.returns;
      scan->returns.push_back(R_W_S * point_S);
    } else {
      ++count.too_far;
      // What was met beyond the range is a surface, too: its rays are cut off as those of others
      // are.
      const float free_length = std::min(max_length, length - end_cut);
      if (config_.beyond_max_depth == ReadingPolicy::kFree && free_length > 0.0f) {
        scan->misses.push_back(R_W_S * (point_S * (free_length / length)));
      }
    }
  }
  return count;
}

}  // namespace fiimap
