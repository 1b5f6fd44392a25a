#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiimap/bit_column.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What one scan says about each voxel of the local update box: hit, miss end, passed through.
/// Each is a bit, so many rays through a voxel are one observation. Columns are z-columns of 64-bit
/// words; bit 0 is the lowest voxel of the box. Coordinates are relative to box().min.
class ScanMask {
 public:
  enum Layer { kHit, kMissEnd, kFree };
  static constexpr int kLayerCount = 3;

  /// Starts a scan over `box`; all bits are zero. Keeps its memory from scan to scan.
  void begin(const VoxelBox& box);

  const VoxelBox& box() const { return box_; }
  const VoxelIndex& size() const { return size_; }
  int wordsPerColumn() const { return words_; }

  std::uint64_t* column(Layer layer, int x, int y) {
    return bits_[layer].data() + columnIndex(x, y) * words_;
  }
  const std::uint64_t* column(Layer layer, int x, int y) const {
    return bits_[layer].data() + columnIndex(x, y) * words_;
  }
  bool test(Layer layer, const VoxelIndex& v) const {
    return (column(layer, v.x(), v.y())[v.z() / kWordBits] >> (v.z() % kWordBits)) & 1u;
  }
  /// Whether a column has any bit.
  bool any(Layer layer, int x, int y) const {
    const std::uint64_t* words = column(layer, x, y);
    return std::any_of(words, words + words_, [](std::uint64_t word) { return word != 0; });
  }
  void mark(Layer layer, const VoxelIndex& v) {
    column(layer, v.x(), v.y())[v.z() / kWordBits] |= std::uint64_t{1} << (v.z() % kWordBits);
  }
  /// Sets the bits z_low..z_high (inclusive, clipped to the box) of the free layer.
  void markFreeRun(int x, int y, int z_low, int z_high);

  /// Grows the part of the box that may hold bits; every mark must lie in it.
  void touch(int x, int y);
  /// Columns that may hold bits: [min, max) on x and y.
  const VoxelBox& touched() const { return touched_; }

  std::size_t memoryBytes() const {
    return kLayerCount * bits_[kFree].size() * sizeof(std::uint64_t);
  }

 private:
  std::size_t columnIndex(int x, int y) const {
    return static_cast<std::size_t>(x) * size_.y() + y;
  }

  VoxelBox box_;
  VoxelIndex size_ = VoxelIndex::Zero();
  VoxelBox touched_;
  int words_ = 0;
  std::vector<std::uint64_t> bits_[kLayerCount];
};

inline void ScanMask::markFreeRun(int x, int y, int z_low, int z_high) {
  z_low = std::max(z_low, 0);
  z_high = std::min(z_high, size_.z() - 1);
  if (z_low > z_high) return;
  std::uint64_t* words = column(kFree, x, y);
  const int first = z_low / kWordBits;
  const int last = z_high / kWordBits;
  const std::uint64_t from_low = ~std::uint64_t{0} << (z_low % kWordBits);
  const std::uint64_t to_high = ~std::uint64_t{0} >> (kWordBits - 1 - z_high % kWordBits);
  if (first == last) {
    words[first] |= from_low & to_high;
    return;
  }
  words[first] |= from_low;
  for (int w = first + 1; w < last; ++w) words[w] = ~std::uint64_t{0};
  words[last] |= to_high;
}

}  // namespace fiimap
