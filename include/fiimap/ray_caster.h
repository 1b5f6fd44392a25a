#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiimap/hit_cover.h"
#include "fiimap/kernels.h"
#include "fiimap/range_data.h"
#include "fiimap/ray_slices.h"
#include "fiimap/scan_mask.h"

namespace fiimap {

/// How many rays of a scan were cast, of those that differ.
struct RayCount {
  std::size_t hits = 0;    ///< distinct voxels with a return
  std::size_t misses = 0;  ///< distinct voxels where a ray without return ends
};

/// Marks what the rays of a scan hit and what they pass through, inside a box.
///
/// Definition. The scan's rays end in voxels: returns in one voxel are one ray, to its centre; so
/// are misses. A ray that leaves the box becomes a miss in the last voxel of the box that it
/// crosses.
/// - The voxel of a return is hit.
/// - Free is every voxel that the segment from the origin to the ray's end touches (Amanatides &
///   Woo 1987), where a miss's segment ends in the centre of its voxel and a return's segment
///   `end_cut` voxel edges before it.
/// - Directions are rounded, if wanted: to the centre of the cell that the ray crosses in a side
///   face of a cube around the origin, parallel to the axes, whose cells have a voxel edge and
///   whose middle cells lie on the axes. Half its side is the whole number above the distance along
///   x or y of the end that is farthest along one of them, and a quarter, but at most 512. A
///   rounded segment ends where the straight one does along the axis of the face: at most half a
///   voxel edge beside it on the other axes. Straight are rays steeper than 45 degrees, rays that
///   do not end a quarter of a voxel edge inside of the cube, and all rays of an origin outside of
///   the box.
/// A voxel may be both hit and free; who reads the mask lets the hit win, but HitCover takes the
/// hit from those that hold a sliver.
///
/// Coordinates are single precision, in voxel edges from the box's corner: exact to 1e-4 voxel
/// edges in a box of 1000 voxels a side.
///
/// Rays that share their rounded direction, or a part of their way, are cast together: RaySlices.
/// Not thread-safe (keeps scratch memory).
class RayCaster {
 public:
  /// \param end_cut voxel edges, >= 0.
  /// \param min_hit_cover share of a voxel's face, 0 to 1; see HitCover.
  /// \param round_rays whether directions are rounded; otherwise all rays are straight.
  RayCaster(const VoxelLattice& lattice, double end_cut, double min_hit_cover = 0.0,
            bool round_rays = true);

  /// Casts all rays of `scan` inside `box` into `mask`, which is begun anew.
  RayCount cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask);

 private:
  void listEnds(const PointList& points, const ScanMask& mask, RayEnds* ends) const;
  void listEnd(const Eigen::Vector3f& ray, const ScanMask& mask, RayEnds* ends) const;
  void touchColumns(ScanMask* mask) const;
  void beginCube();
  void markEnds(const RayEnds& ends, bool are_returns, ScanMask* mask, RayCount* count);
  void markEnd(const RayEnds& ends, std::int32_t k, bool are_returns, ScanMask* mask);
  void castRays(const RayEnds& ends, std::vector<std::int32_t>* listed, float cut, ScanMask* mask);
  void castStraight(const RayEnds& ends, std::int32_t k, float cut, ScanMask* mask);
  void walkTo(int end_x, int end_y, const ScanMask& mask);
  float endOfRay(int x, int y, float rise, float cut) const;

  VoxelLattice lattice_;
  float end_cut_;
  HitCover hit_cover_;
  bool round_rays_;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();  // of the scan, in voxels relative to the box
  bool origin_is_inside_ = true;
  RayEnds misses_, returns_;
  std::vector<std::int32_t> cut_rays_, whole_rays_;  // ends of distinct rays, by index
  DirectionCube cube_{1, {0.0f, 0.0f, 0.0f}};
  CubeRays rays_;
  RaySlices slices_;
  ColumnWalk walk_;
  const Kernels& kernels_;
};

}  // namespace fiimap
