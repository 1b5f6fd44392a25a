#pragma once

#include <cstddef>
#include <vector>

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
/// A voxel may be both hit and free; who reads the mask lets the hit win.
///
/// Rays that end in one column share their walk over columns, and rays that end in a run of
/// neighbouring voxels of it pass each column in one run of voxels: this is what makes it fast.
/// Not thread-safe (keeps scratch memory).
class RayCaster {
 public:
  /// \param end_cut voxel edges, >= 0.
  RayCaster(const VoxelLattice& lattice, double end_cut);

  /// Casts all rays of `scan` inside `box` into `mask`, which is begun anew.
  RayCount cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask);

 private:
  /// A column on the way to an end column; the ray is in it from the end of the last one (t = 0 at
  /// the origin) until t_out (t = 1 at the end).
  struct Crossing {
    int x, y;
    double t_in, t_out;
  };

  void markEnds(const RangeData& scan, ScanMask* mask, RayCount* count);
  void markEnd(const Eigen::Vector3d& end, bool is_return, ScanMask* mask, RayCount* count);
  void walkTo(int x, int y, const ScanMask& mask);
  void carve(int end_x, int end_y, ScanMask* mask) const;
  void carveFan(int z_low, int z_high, double cut, int end_x, int end_y, ScanMask* mask) const;
  double endOfRay(int end_x, int end_y, int z, double cut) const;

  VoxelLattice lattice_;
  double end_cut_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // of the scan, in voxels relative to the box
  std::vector<Eigen::Vector2i> end_columns_;
  std::vector<Crossing> walk_;
};

}  // namespace fiimap
