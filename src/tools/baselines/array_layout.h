#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "fiimap/voxel_lattice.h"

namespace fiimap::bench {

/// Row-major array over a fixed box of voxels: z-rows are contiguous.
class ArrayLayout {
 public:
  /// \throws std::invalid_argument when arrays over the box would not fit into common memory.
  explicit ArrayLayout(const VoxelBox& box)
      : box_(box),
        stride_x_(static_cast<std::size_t>(box.size().y()) * box.size().z()),
        stride_y_(box.size().z()) {
    constexpr std::int64_t kMaxVoxels = 400000000;
    if (box.volume() > kMaxVoxels) {
      throw std::invalid_argument(
          "the arrays of ego, per_pixel and byte_batch, which cover the whole path, would have " +
          std::to_string(box.volume()) + " voxels, at most " + std::to_string(kMaxVoxels) +
          " are possible; leave these methods out with --methods, or set a coarser resolution");
    }
  }

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
