#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/sliding_grid.h"
#include "fiimap/structuring_element.h"

namespace fiimap {

/// Adds a structuring element around voxels to the inflated plane: all that an obstacle does which
/// only appears. Not thread-safe (keeps scratch memory).
class ElementStamp {
 public:
  explicit ElementStamp(const StructuringElement& element);

  /// Whether the element around the voxel lies in columns of the window.
  bool fits(const VoxelIndex& v, const VoxelBox& window) const;
  /// Adds the element around a voxel for which it fits, cut off at the window's top and bottom.
  void apply(const VoxelIndex& v, SlidingGrid* grid);

 private:
  /// A column of the element.
  struct Column {
    int position;  ///< in print_
    int half_height;
  };
  /// Empty columns on both sides along y, so that the print can be taken in whole groups.
  static constexpr int kMargin = Strip::kGroup;

  void print(const VoxelIndex& v, const SlidingGrid& grid);
  /// From a column of the print to the one of the next x.
  int step() const { return 2 * reach_ + 1 + 2 * kMargin; }

  int reach_;
  std::vector<Column> columns_;
  std::vector<std::uint64_t> heights_;  // by half height and word
  std::vector<std::uint64_t> print_;    // what a voxel adds: by dx, dy and word
};

}  // namespace fiimap
