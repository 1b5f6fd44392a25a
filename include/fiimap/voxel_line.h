#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Calls visit(voxel, t_in, t_out) for every voxel that the segment from + t * (to - from), t in
/// [0, 1], passes, in the order in which it enters them, until visit returns false.
///
/// Definition. On each axis the segment is in index i for an interval of t: where the floor of its
/// coordinate is i, and the ends of that interval. It passes a voxel when the intervals of its
/// three indices have a t in common; the first is t_in, the last t_out. So the voxels of both ends
/// belong to it, and so do all voxels around an edge or a corner that it crosses on its way
/// through. A segment within a face has the voxels on the upper side of that face only, as a point
/// has.
///
/// Intervals that are less than 1e-9 voxel edges along the segment apart, or 1e-15 of it, count as
/// touching: rounding leaves out no voxel.
/// \param from, to in voxels (VoxelLattice::toVoxels), in the range of voxel indices.
/// \return whether visit returned true for all of them.
template <typename Visitor>
bool forEachVoxelOnLine(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visitor&& visit) {
  constexpr double kTieVoxels = 1e-9, kTieShare = 1e-15;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d direction = to - from;
  VoxelIndex v = from.array().floor().cast<int>();
  const VoxelIndex last = to.array().floor().cast<int>();
  const VoxelIndex step = (last - v).cwiseSign();
  const double tie = std::max(kTieShare, kTieVoxels / direction.cwiseAbs().maxCoeff());

  // Where the segment leaves the voxel's index on an axis. Not summed up, so that errors do not.
  const auto exitOf = [&](int axis) {
    if (v[axis] == last[axis]) return kNever;
    const double border = v[axis] + (step[axis] > 0 ? 1.0 : 0.0);
    return std::clamp((border - from[axis]) / direction[axis], 0.0, 1.0);
  };
  Eigen::Vector3d exits(exitOf(0), exitOf(1), exitOf(2));
  double t_in = 0.0;
  for (;;) {
    const double t = exits.minCoeff();
    if (!visit(static_cast<const VoxelIndex&>(v), t_in, std::min(t, 1.0))) return false;
    if (t == kNever) return true;
    VoxelIndex stride = VoxelIndex::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      if (exits[axis] != kNever && exits[axis] <= t + tie) stride[axis] = step[axis];
    }
    // The corner (1, 1, 1) is where the segment goes on; the others are touched on the way.
    constexpr int kLastCorner = 7;
    for (int corner = 1; corner < kLastCorner; ++corner) {
      const VoxelIndex side(corner & 1, (corner >> 1) & 1, corner >> 2);
      const bool is_another = (side.array() == 0 || stride.array() != 0).all() &&
                              (stride.array() != 0).count() > side.sum();
      const VoxelIndex touched = v + side.cwiseProduct(stride);
      if (is_another && !visit(touched, t, t)) return false;
    }
    v += stride;
    for (int axis = 0; axis < 3; ++axis) {
      if (stride[axis] != 0) exits[axis] = exitOf(axis);
    }
    t_in = t;
  }
}

}  // namespace fiimap
