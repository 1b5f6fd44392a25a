#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "fiimap/kernels.h"
#include "fiimap/range_data.h"
#include "fiimap/scan_mask.h"

namespace fiimap {

/// Tells voxels that a surface fills from those that hold a sliver of one, or noise.
///
/// Definition. The cover of a voxel is the number of returns in it, divided by the number that a
/// surface of the size of its face would give that faces the sensor at the distance of the voxel's
/// centre. Where rays pass a voxel whose cover is less than `min_cover`, the voxel is not hit: the
/// sensor sees through it. Not in the paper; docs/accuracy.md says what it is good for.
/// Not thread-safe (keeps scratch memory).
class HitCover {
 public:
  /// \param min_cover share of a voxel's face, 0 to 1; 0: a hit always wins.
  explicit HitCover(double min_cover) : min_cover_(min_cover), kernels_(kernels()) {}

  /// Takes the hit from the voxels that are free and that the returns cover too little.
  /// \param ends of the returns, all marked as hit where they do not leave the box.
  /// \param origin of the rays, voxel edges from the corner of the mask's box.
  /// \return how many voxels are no longer hit.
  std::size_t dropSlivers(const RangeData& scan, const RayEnds& ends, const Eigen::Vector3f& origin,
                          double resolution, ScanMask* mask);

 private:
  /// Bit `bit` of word `word` of the mask.
  struct Voxel {
    std::int32_t word;
    std::int32_t bit;
    std::int32_t returns;
  };

  void listPassed(const RayEnds& ends, const ScanMask& mask);
  void listNear(const RayEnds& ends, const PointList& returns, float max_length_2);
  void countReturns(const RayEnds& ends, const ScanMask& mask);
  Voxel& find(std::int32_t word, std::int32_t bit);

  double min_cover_;
  const Kernels& kernels_;
  std::vector<std::int32_t> ends_;   // listed, of those handed in
  std::vector<Voxel> voxels_;        // in which they are
  std::vector<std::int32_t> table_;  // hash table of voxels_; its size is a power of two
};

}  // namespace fiimap
