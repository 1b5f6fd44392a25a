#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Calls visit(voxel, t_out) for every voxel that the segment from `from` to `to` passes through,
/// in its order (Amanatides & Woo 1987). Points are in voxel edges; the segment leaves the voxel at
/// from + t_out * (to - from), and the last one has t_out = 1. Where it passes through an edge or a
/// corner, rounding decides which of the voxels around it are visited in between.
/// The walk ends early when visit returns false.
template <typename Visitor>
void walkVoxels(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visitor&& visit) {
  VoxelIndex v = from.array().floor().cast<int>();
  const VoxelIndex last = to.array().floor().cast<int>();
  const Eigen::Vector3d direction = to - from;
  VoxelIndex steps_left = (last - v).cwiseAbs();
  VoxelIndex step;
  Eigen::Vector3d t_next, t_delta;
  for (int axis = 0; axis < 3; ++axis) {
    const bool crosses = steps_left[axis] > 0;
    step[axis] = last[axis] > v[axis] ? 1 : -1;
    const double boundary = v[axis] + (step[axis] > 0 ? 1.0 : 0.0);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    t_next[axis] = crosses ? (boundary - from[axis]) / direction[axis] : kNever;
    t_delta[axis] = crosses ? step[axis] / direction[axis] : kNever;
  }
  while (steps_left.sum() > 0) {
    int axis = 0;
    const double t_out = t_next.minCoeff(&axis);
    if (!visit(static_cast<const VoxelIndex&>(v), std::min(t_out, 1.0))) return;
    v[axis] += step[axis];
    const bool crosses_again = --steps_left[axis] > 0;
    t_next[axis] =
        crosses_again ? t_next[axis] + t_delta[axis] : std::numeric_limits<double>::infinity();
  }
  visit(static_cast<const VoxelIndex&>(v), 1.0);
}

}  // namespace fiimap
