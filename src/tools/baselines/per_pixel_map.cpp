#include "per_pixel_map.h"

#include "ray_walk.h"

namespace fiimap::bench {

void PerPixelMap::castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                          bool is_return) {
  Eigen::Vector3d free_end = end;
  if (is_return) {
    observe(end.array().floor().cast<int>(), true);
    const double length = (end - origin).norm();
    if (length <= config().ray_end_cut) return;
    free_end = origin + (1.0 - config().ray_end_cut / length) * (end - origin);
  }
  walkVoxels(origin, free_end, [&](const VoxelIndex& v) {
    observe(v, false);
    return true;
  });
}

}  // namespace fiimap::bench
