#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "array_layout.h"
#include "fiimap/structuring_element.h"

namespace fiimap::bench {

/// Batch inflation over bytes, as ego-planner does it with a cube: clears a box and sets the
/// structuring element around every occupied voxel of it, one byte per voxel, row by row.
/// Inside the box shrunk by the element's reach, the result is the exact dilation.
class BatchInflation {
 public:
  BatchInflation(const StructuringElement& element, const ArrayLayout& layout);

  /// \param is_occupied called with the array index of each voxel of `box`.
  /// \param box inside the layout's box.
  template <typename IsOccupied>
  void inflate(const VoxelBox& box, IsOccupied&& is_occupied, std::vector<std::uint8_t>* inflated);

 private:
  /// The element's voxels at one horizontal offset.
  struct Row {
    int dx, dy, half_height;
  };

  void inflateVoxel(const VoxelIndex& v, std::uint8_t* inflated) const;

  ArrayLayout layout_;
  std::vector<Row> rows_;
};

inline BatchInflation::BatchInflation(const StructuringElement& element, const ArrayLayout& layout)
    : layout_(layout) {
  const int reach = element.reach();
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      const int half_height = element.halfHeight(dx, dy);
      if (half_height >= 0) rows_.push_back({dx, dy, half_height});
    }
  }
}

template <typename IsOccupied>
void BatchInflation::inflate(const VoxelBox& box, IsOccupied&& is_occupied,
                             std::vector<std::uint8_t>* inflated) {
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      std::fill_n(inflated->begin() + layout_.indexOf(x, y, box.min.z()), box.size().z(), 0);
    }
  }
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      std::size_t index = layout_.indexOf(x, y, box.min.z());
      for (int z = box.min.z(); z < box.max.z(); ++z, ++index) {
        if (is_occupied(index)) inflateVoxel({x, y, z}, inflated->data());
      }
    }
  }
}

inline void BatchInflation::inflateVoxel(const VoxelIndex& v, std::uint8_t* inflated) const {
  const VoxelBox& box = layout_.box();
  for (const Row& row : rows_) {
    const int x = v.x() + row.dx;
    const int y = v.y() + row.dy;
    if (!box.containsColumn(x, y)) continue;
    const int low = std::max(v.z() - row.half_height, box.min.z());
    const int high = std::min(v.z() + row.half_height, box.max.z() - 1);
    std::fill(inflated + layout_.indexOf(x, y, low), inflated + layout_.indexOf(x, y, high) + 1, 1);
  }
}

}  // namespace fiimap::bench
