#include "fiimap/voxel_lattice.h"

#include <cmath>

namespace fiimap {
namespace {

/// Indices stay far enough from the limits of int that sums with window sizes cannot overflow.
constexpr double kMaxAbsIndex = 1 << 30;

}  // namespace

std::int64_t VoxelBox::volume() const {
  if (empty()) return 0;
  const VoxelIndex s = size();
  return static_cast<std::int64_t>(s.x()) * s.y() * s.z();
}

bool VoxelLattice::canIndex(const Eigen::Vector3d& point_W) const {
  return point_W.allFinite() && point_W.cwiseAbs().maxCoeff() * voxels_per_metre_ < kMaxAbsIndex;
}

VoxelIndex VoxelLattice::sizeOf(const Eigen::Vector3d& extent) const {
  return (extent / resolution_).array().round().max(1.0).cast<int>();
}

}  // namespace fiimap
