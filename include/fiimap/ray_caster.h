#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiimap/hit_cover.h"
#include "fiimap/kernels.h"
#include "fiimap/range_data.h"
#include "fiimap/scan_mask.h"

namespace fiimap {

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
/// A voxel may be both hit and free; who reads the mask lets the hit win, but HitCover takes the hit
/// from those that hold a sliver.
///
/// Coordinates are single precision, in voxel edges from the box's corner: exact to 1e-4 voxel
/// edges in a box of 1000 voxels a side.
///
/// Rays that end in one column share their walk over columns, and rays that end in a run of
/// neighbouring voxels of it pass each column in one run of voxels: this is what makes it fast.
/// Not thread-safe (keeps scratch memory).
class RayCaster {
 public:
  /// \param end_cut voxel edges, >= 0.
  /// \param min_hit_cover share of a voxel's face, 0 to 1; see HitCover.
  RayCaster(const VoxelLattice& lattice, double end_cut, double min_hit_cover = 0.0);

  /// Casts all rays of `scan` inside `box` into `mask`, which is begun anew.
  RayCount cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask);

 private:
  /// Rays to the voxels z_low..z_high (inclusive) of one column.
  struct Fan {
    int z_low, z_high;
    float cut;         // voxel edges before the end
    float distance_2;  // horizontal distance of the end column, squared
  };

  void markEnds(const PointList& ends, bool are_returns, ScanMask* mask, RayCount* count);
  void listEnds(const PointList& ends, const ScanMask& mask);
  void listEnd(const Eigen::Vector3f& ray, const ScanMask& mask);
  void walkTo(int end_x, int end_y, ScanMask* mask);
  void carve(int end_x, int end_y, ScanMask* mask);
  void carveFan(const Fan& fan, ScanMask* mask);
  void carveRay(const Fan& ray, ScanMask* mask);
  void carveTogether(const Fan& fan, int columns, ScanMask* mask) const;
  void carveApart(const Fan& fan, int first, ScanMask* mask) const;
  float endOfRay(const Fan& fan, int z) const;

  VoxelLattice lattice_;
  float end_cut_;
  HitCover hit_cover_;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();  // of the scan, in voxels relative to the box
  RayEnds ends_;
  ColumnWalk walk_;
  const Kernels& kernels_;
};

}  // namespace fiimap
