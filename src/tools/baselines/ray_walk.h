#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "fiimap/voxel_lattice.h"

namespace fiimap::bench {

/// Amanatides & Woo 1987: calls visit(voxel) for every voxel from `start` to `end` (voxel units) in
/// this order, both included, until it returns false.
template <typename Visitor>
void walkVoxels(const Eigen::Vector3d& start, const Eigen::Vector3d& end, Visitor&& visit) {
  VoxelIndex cell = start.array().floor().cast<int>();
  const VoxelIndex last = end.array().floor().cast<int>();
  const Eigen::Vector3d direction = end - start;
  VoxelIndex step;
  Eigen::Vector3d t_next, t_delta;
  int steps_left = 0;
  for (int axis = 0; axis < 3; ++axis) {
    step[axis] = last[axis] > cell[axis] ? 1 : -1;
    const int crossings = std::abs(last[axis] - cell[axis]);
    const double boundary = cell[axis] + (step[axis] > 0 ? 1.0 : 0.0);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    t_next[axis] = crossings > 0 ? (boundary - start[axis]) / direction[axis] : kNever;
    t_delta[axis] = crossings > 0 ? step[axis] / direction[axis] : kNever;
    steps_left += crossings;
  }
  while (visit(cell) && steps_left-- > 0) {
    int axis = t_next[0] < t_next[1] ? 0 : 1;
    if (t_next[2] < t_next[axis]) axis = 2;
    cell[axis] += step[axis];
    // Rounding must not lead past the last voxel.
    t_next[axis] = cell[axis] == last[axis] ? std::numeric_limits<double>::infinity()
                                            : t_next[axis] + t_delta[axis];
  }
}

}  // namespace fiimap::bench
