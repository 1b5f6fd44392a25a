#include "truth/passed_voxels.h"

#include <algorithm>
#include <cmath>

#include "fiimap/voxel_line.h"
#include "seen_surface.h"
#include "truth/passing_margin.h"

namespace fiimap {

void PassedVoxels::add(const RangeData& scan, const ExactScene& scene, double time) {
  const double to_voxels = 1.0 / lattice_.resolution();
  for (std::size_t i = 0; i < scan.returns.size(); i += kEveryReturn) {
    const Eigen::Vector3d direction_W = scan.returns[i].cast<double>().normalized();
    const double length =
        std::min(scene.firstHit(scan.origin, direction_W, time).distance, max_range_);
    const Eigen::Vector3d end = (scan.origin + length * direction_W) * to_voxels;
    const VoxelIndex last = end.array().floor().cast<int>();
    forEachVoxelOnLine(scan.origin * to_voxels, end, [&](const VoxelIndex& v, double, double) {
      if (v != last && ever_.insert(keyOf(v)).second) {
        passed_.push_back(v);
      }
      return true;
    });
  }
}

void PassedVoxels::compare(const Snapshot& map, const ExactScene& scene, const VoxelBox& box,
                           double time, FreeSpaceCount* count) const {
  const VoxelBox inside = box.intersection(map.window());
  const double half_diagonal = lattice_.resolution() * std::sqrt(3.0) / 2.0;
  for (const VoxelIndex& v : passed_) {
    if (!inside.contains(v)) continue;
    const Eigen::Vector3d center_W = lattice_.centerOf(v);
    if (scene.signedDistance(center_W, time) <= half_diagonal) continue;
    if (isNearPassing(scene, center_W, SeenSurface::kPassingMargin)) continue;
    ++count->free;
    const Occupancy state = map.occupancy(v);
    if (state == Occupancy::kFree) ++count->found;
    if (state == Occupancy::kOccupied) ++count->occupied;
  }
}

}  // namespace fiimap
