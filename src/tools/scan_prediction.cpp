#include "scan_prediction.h"

#include "fiimap/voxel_line.h"

namespace fiimap {
namespace {

bool isOccupied(const OccupancyQuery& map, const VoxelIndex& v) {
  return map(v) == Occupancy::kOccupied;
}

bool isOccupiedAround(const OccupancyQuery& map, const VoxelIndex& v) {
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        if (isOccupied(map, v + VoxelIndex(dx, dy, dz))) return true;
      }
    }
  }
  return false;
}

/// \param from, to in voxel edges.
bool isBlocked(const OccupancyQuery& map, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double length = (to - from).norm();
  bool blocked = false;
  forEachVoxelOnLine(from, to, [&](const VoxelIndex& v, double /*t_in*/, double t_out) {
    const bool well_before_end = (1.0 - t_out) * length > kBlockedBeforeEnd;
    blocked = well_before_end && isOccupied(map, v);
    return well_before_end && !blocked;
  });
  return blocked;
}

}  // namespace

ScanPrediction predict(const OccupancyQuery& map, const VoxelLattice& lattice,
                       const RangeData& scan) {
  ScanPrediction result;
  const double to_voxels = 1.0 / lattice.resolution();
  for (const Eigen::Vector3f& offset : scan.returns) {
    const Eigen::Vector3d end_W = scan.origin + offset.cast<double>();
    const VoxelIndex end = lattice.indexOf(end_W);
    ++result.rays;
    if (map(end) == Occupancy::kOutside) ++result.outside;
    if (isOccupied(map, end)) ++result.hits;
    if (isOccupiedAround(map, end)) ++result.near;
    if (isBlocked(map, scan.origin * to_voxels, end_W * to_voxels)) ++result.blocked;
  }
  return result;
}

ScanPrediction predict(const Snapshot& map, const RangeData& scan) {
  const auto query = [&map](const VoxelIndex& v) { return map.occupancy(v); };
  return predict(query, map.lattice(), scan);
}

}  // namespace fiimap
