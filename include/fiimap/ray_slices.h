#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "fiimap/kernels.h"
#include "fiimap/scan_mask.h"

namespace fiimap {

/// Frees the voxels along rays whose directions are rounded to the cells of a DirectionCube.
///
/// The rays through one column of cells lie in a vertical half plane, a slice: they cross the same
/// columns of voxels, which are found once. Rays through one cell are a beam, as long as the
/// longest of them. Neighbouring beams are at most a voxel edge apart wherever they are inside the
/// cube, so that as long as none of them has ended they touch one run of voxels in each column: the
/// work grows with the number of slices and of beams' ends, not with that of rays. Not thread-safe
/// (keeps scratch memory).
class RaySlices {
 public:
  RaySlices() : kernels_(kernels()) {}

  /// Begins a scan. The origin must lie in the box of the mask.
  void begin(const DirectionCube& cube);

  /// Adds a ray through a cell, of a reach above 0 and no longer than half the cube's side.
  void add(std::int32_t slice, std::int32_t cell, float reach);

  /// Frees what the rays pass.
  void carve(ScanMask* mask);

 private:
  struct Slice {
    std::int32_t index;
    std::int32_t first_cell, last_cell;  // where its beams are
    float reach;                         // of the longest
  };
  static constexpr std::int32_t kNone = -1;

  void walkAlong(const Slice& slice, const ScanMask& mask);
  void findEnds(int beams);
  int columnAt(float distance) const;
  void closeGap(int before, int after);
  void sweep(int first_cell, ScanMask* mask);
  void endBeams(int k, int first_cell, ScanMask* mask);
  void listRuns(int first_cell);
  float slopeOf(int cell) const { return static_cast<float>(cell - cube_.half_side) * per_cell_; }

  DirectionCube cube_{1, {0.0f, 0.0f, 0.0f}};
  float per_cell_ = 1.0f;              // slope from one cell to the next
  std::vector<std::int32_t> slot_of_;  // of a slice in slices_, or kNone
  std::vector<Slice> slices_;
  std::vector<float> reach_;  // by slot and cell; 0 where there is no beam
  const Kernels& kernels_;

  // Of the slice that is being carved.
  ColumnWalk walk_;            // t is the distance along the axis of the face
  float first_border_ = 0.0f;  // where its first slab begins
  int slabs_ = 0;
  const float* beam_reach_ = nullptr;  // of its beams
  std::vector<std::int32_t> last_;     // column in which a beam ends; kNone where there is none
  std::vector<std::int32_t> ending_;   // a beam that ends in a column, or kNone
  std::vector<std::int32_t> next_;     // after a beam, another one that ends in the same column
  std::vector<std::uint64_t> alive_;   // bits of the beams that have not ended
  std::vector<float> rise_low_, rise_high_;
};

}  // namespace fiimap
