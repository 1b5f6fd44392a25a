#pragma once

#include <cstddef>

#include "fiimap/voxel_lattice.h"

namespace fiimap::bench {

/// Row-major array over a fixed box of voxels: z-rows are contiguous.
class ArrayLayout {
 public:
  explicit ArrayLayout(const VoxelBox& box)
      : box_(box),
        stride_x_(static_cast<std::size_t>(box.size().y()) * box.size().z()),
        stride_y_(box.size().z()) {}

  const VoxelBox& box() const { return box_; }
  std::size_t voxels() const { return stride_x_ * box_.size().x(); }
  std::size_t indexOf(int x, int y, int z) const {
    return (x - box_.min.x()) * stride_x_ + (y - box_.min.y()) * stride_y_ + (z - box_.min.z());
  }
  std::size_t indexOf(const VoxelIndex& v) const { return indexOf(v.x(), v.y(), v.z()); }

 private:
  VoxelBox box_;
  std::size_t stride_x_;
  std::size_t stride_y_;
};

}  // namespace fiimap::bench
