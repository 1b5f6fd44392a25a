#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace fiimap {

/// Integer coordinates of a voxel of the world: voxel v covers [v, v + 1) * resolution on each
/// axis. Global and unbounded (negative too); it does not depend on where the window is.
using VoxelIndex = Eigen::Vector3i;

/// Half-open box of voxels [min, max).
struct VoxelBox {
  VoxelIndex min = VoxelIndex::Zero();  ///< lowest voxel inside, on each axis
  VoxelIndex max = VoxelIndex::Zero();  ///< lowest voxel above the box, on each axis

  /// Voxels along each axis; of an empty box, some are not above 0.
  VoxelIndex size() const { return max - min; }
  /// Whether no voxel is inside.
  bool empty() const { return (max.array() <= min.array()).any(); }
  /// Number of voxels.
  std::int64_t volume() const;
  /// Whether a voxel is inside.
  bool contains(const VoxelIndex& v) const {
    return (v.array() >= min.array()).all() && (v.array() < max.array()).all();
  }
  /// The same, whatever z is.
  bool containsColumn(int x, int y) const {
    return x >= min.x() && x < max.x() && y >= min.y() && y < max.y();
  }
  /// What lies in both; may be empty.
  VoxelBox intersection(const VoxelBox& other) const {
    return {min.cwiseMax(other.min), max.cwiseMin(other.max)};
  }
  ///@{
  /// Whether the corners are the same.
  bool operator==(const VoxelBox& other) const { return min == other.min && max == other.max; }
  bool operator!=(const VoxelBox& other) const { return !(*this == other); }
  ///@}
};

/// The corners of a box of voxels as numbers with which points in voxels can be compared.
struct VoxelBounds {
  /// Of the box.
  explicit VoxelBounds(const VoxelBox& box)
      : min(box.min.cast<double>()), max(box.max.cast<double>()) {}
  /// Whether a point (voxels) is inside; one that is not finite is not.
  bool contains(const Eigen::Vector3d& p) const {
    bool inside = true;  // without branches, which are guessed wrong near a border
    for (int axis = 0; axis < 3; ++axis) inside &= (p[axis] >= min[axis]) & (p[axis] < max[axis]);
    return inside;
  }

  Eigen::Vector3d min;  ///< voxels
  Eigen::Vector3d max;  ///< voxels
};

/// Largest integer that is not above the value, which must be a number in the range of int. Without
/// SSE4.1, std::floor is a function call.
template <typename Scalar>
int floorToInt(Scalar value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < static_cast<Scalar>(truncated) ? 1 : 0);
}

/// The only place where metres become voxels and back (eq. 1 of the paper, with a floored division
/// so that it holds for negative coordinates). Immutable, safe to share between threads.
class VoxelLattice {
 public:
  /// \param resolution edge length of a voxel in metres, > 0.
  explicit VoxelLattice(double resolution)
      : resolution_(resolution), voxels_per_metre_(1.0 / resolution) {}

  /// Edge length of a voxel, m.
  double resolution() const { return resolution_; }

  /// A point (metres) in voxels: the voxel that holds it is the floor.
  Eigen::Vector3d toVoxels(const Eigen::Vector3d& point_W) const {
    return point_W * voxels_per_metre_;
  }
  /// Voxel that holds the point (metres). Requires canIndex(point_W).
  VoxelIndex indexOf(const Eigen::Vector3d& point_W) const { return floorOf(toVoxels(point_W)); }
  /// Voxel within the bounds that holds the point (metres).
  /// \return false when none does, or the point is not finite; v is left as it was.
  bool indexIn(const VoxelBounds& bounds, const Eigen::Vector3d& point_W, VoxelIndex* v) const {
    const Eigen::Vector3d p = toVoxels(point_W);
    const bool inside = bounds.contains(p);
    if (inside) *v = floorOf(p);
    return inside;
  }
  /// False for points that are not finite or lie beyond the range of voxel indices.
  bool canIndex(const Eigen::Vector3d& point_W) const;

  /// Centre of a voxel in metres.
  Eigen::Vector3d centerOf(const VoxelIndex& v) const {
    return (v.cast<double>().array() + 0.5) * resolution_;
  }
  /// Number of voxels needed to cover an extent in metres, rounded to the nearest voxel, at
  /// least 1.
  VoxelIndex sizeOf(const Eigen::Vector3d& extent) const;

  /// Box of the given size (voxels) whose middle voxel is `center`.
  static VoxelBox boxAround(const VoxelIndex& center, const VoxelIndex& size) {
    const VoxelIndex min = center - size / 2;
    return {min, min + size};
  }

 private:
  static VoxelIndex floorOf(const Eigen::Vector3d& p) {
    return {floorToInt(p.x()), floorToInt(p.y()), floorToInt(p.z())};
  }

  double resolution_;
  double voxels_per_metre_;  // multiplied with: a division is a third of the time of a query
};

}  // namespace fiimap
