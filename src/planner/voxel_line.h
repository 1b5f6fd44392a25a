#pragma once

#include <cmath>
#include <limits>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Calls visit(VoxelIndex) for every voxel that a line touches, from its start on, until visit
/// returns false. Where the line passes through an edge or a corner, all voxels there are visited.
/// \param from, to in voxels: metres divided by the resolution.
/// \return whether visit returned true for all of them.
template <typename Visitor>
bool forEachVoxelOnLine(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visitor&& visit) {
  constexpr double kTie = 1e-9;  // share of the line within which crossings count as one
  VoxelIndex v = from.array().floor().cast<int>();
  if (!visit(v)) return false;

  // Share of the line at which it crosses the next border of each axis, and between two borders.
  const Eigen::Vector3d direction = to - from;
  VoxelIndex step;
  Eigen::Vector3d next, period;
  for (int axis = 0; axis < 3; ++axis) {
    step[axis] = direction[axis] > 0.0 ? 1 : direction[axis] < 0.0 ? -1 : 0;
    period[axis] =
        step[axis] == 0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(direction[axis]);
    const double border = v[axis] + (step[axis] > 0 ? 1.0 : 0.0);
    next[axis] = step[axis] == 0 ? period[axis] : (border - from[axis]) / direction[axis];
  }
  while (next.minCoeff() < 1.0) {
    const double crossing = next.minCoeff() + kTie;
    VoxelIndex stride = VoxelIndex::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      if (next[axis] > crossing) continue;
      stride[axis] = step[axis];
      next[axis] += period[axis];
    }
    // The corner (1, 1, 1) is where the line goes on; the others are touched on the way.
    constexpr int kCorners = 8;
    for (int corner = 1; corner < kCorners; ++corner) {
      const VoxelIndex side(corner & 1, (corner >> 1) & 1, corner >> 2);
      const bool is_new = (side.array() == 0 || stride.array() != 0).all();
      if (is_new && !visit(v + side.cwiseProduct(stride))) return false;
    }
    v += stride;
  }
  return true;
}

}  // namespace fiimap
