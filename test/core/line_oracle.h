#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "oracle.h"

namespace fiimap::test {

/// A number as numerator and denominator > 0; small ones compare exactly.
struct Fraction {
  std::int64_t numerator;
  std::int64_t denominator;

  double value() const { return static_cast<double>(numerator) / denominator; }
  bool operator<(const Fraction& o) const {
    return numerator * o.denominator < o.numerator * denominator;
  }
  bool operator==(const Fraction& o) const { return !(*this < o) && !(o < *this); }
};

/// A voxel that a segment passes, from and up to which share of it.
struct PassedVoxel {
  VoxelIndex v;
  Fraction t_in, t_out;
};

/// A segment between points of a grid of `kParts` parts of a voxel edge: integer arithmetic, so
/// that nothing is rounded.
class GridSegment {
 public:
  static constexpr int kParts = 8;

  /// \param from, to in parts.
  GridSegment(const VoxelIndex& from, const VoxelIndex& to) : from_(from), to_(to) {}

  Eigen::Vector3d from() const { return from_.cast<double>() / kParts; }
  Eigen::Vector3d to() const { return to_.cast<double>() / kParts; }

  /// All voxels that it passes, by the definition, in any order.
  std::vector<PassedVoxel> passed() const {
    const VoxelIndex a = floorOf(from_), b = floorOf(to_);
    std::vector<PassedVoxel> passed;
    forEachVoxel({a.cwiseMin(b), a.cwiseMax(b).array() + 1}, [&](const VoxelIndex& v) {
      PassedVoxel voxel{v, {0, 1}, {1, 1}};
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t way = to_[axis] - from_[axis];
        if (way == 0) continue;  // in its index all the time
        const std::int64_t low = std::int64_t{v[axis]} * kParts - from_[axis];
        const std::int64_t high = low + kParts;
        const Fraction enter = way > 0 ? Fraction{low, way} : Fraction{-high, -way};
        const Fraction leave = way > 0 ? Fraction{high, way} : Fraction{-low, -way};
        voxel.t_in = std::max(voxel.t_in, enter);
        voxel.t_out = std::min(voxel.t_out, leave);
      }
      if (!(voxel.t_out < voxel.t_in)) passed.push_back(voxel);
    });
    return passed;
  }

 private:
  static VoxelIndex floorOf(const VoxelIndex& parts) {
    return (parts.cast<double>() / kParts).array().floor().cast<int>();
  }

  VoxelIndex from_, to_;
};

}  // namespace fiimap::test
