#pragma once

#include <string>
#include <vector>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Shape of a StructuringElement.
enum class ElementShape { kBall, kCube, kDiamond };

/// The set of voxel offsets by which an obstacle is inflated:
/// inflated(v) <=> some occupied u of the window has v - u in the element.
///
/// With L = radius / resolution:
/// - ball: Euclidean norm of the offset <= L (L need not be whole);
/// - cube: largest absolute coordinate <= ceil(L) (ego-planner's inflation);
/// - diamond: sum of absolute coordinates <= ceil(L) (the paper's 6-connected search of depth L).
///
/// All three are symmetric and convex along z, so a column of the element at horizontal offset
/// (dx, dy) is fully described by its half height. Immutable value.
class StructuringElement {
 public:
  /// \param radius metres, >= 0; \param resolution metres per voxel, > 0.
  StructuringElement(ElementShape shape, double radius, double resolution);

  /// As given to the constructor.
  ElementShape shape() const { return shape_; }
  /// Radius as asked for, metres.
  double radius() const { return radius_; }
  /// Largest absolute coordinate of an offset, voxels: the paper's L.
  int reach() const { return reach_; }
  /// Largest h with (dx, dy, h) in the element; -1 when (dx, dy) is outside its footprint.
  int halfHeight(int dx, int dy) const;
  /// Whether an offset is in the element.
  bool contains(const VoxelIndex& offset) const;
  /// All offsets, the zero offset included, in lexicographic order.
  const std::vector<VoxelIndex>& offsets() const { return offsets_; }

 private:
  bool satisfiesDefinition(const VoxelIndex& offset) const;

  ElementShape shape_;
  double radius_;
  double radius_voxels_;
  int reach_;
  std::vector<int> half_heights_;  // (2 reach + 1)^2, row dx
  std::vector<VoxelIndex> offsets_;
};

}  // namespace fiimap
