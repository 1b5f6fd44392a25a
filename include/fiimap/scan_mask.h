#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What one scan says about each voxel of the local update box: hit, miss end, passed through.
/// Each is a bit, so many rays through a voxel are one observation. Columns are z-columns of 64-bit
/// words; bit 0 is the lowest voxel of the box. Coordinates are relative to box().min.
class ScanMask {
 public:
  /// A bit per voxel: a ray returned from it, ended in it without a return, passed it.
  enum Layer { kHit, kMissEnd, kFree };
  static constexpr int kLayerCount = 3;  ///< of Layer

  /// Starts a scan over `box`; all bits are zero. Keeps its memory from scan to scan.
  void begin(const VoxelBox& box);

  /// Voxels of the map that the mask is over.
  const VoxelBox& box() const { return box_; }
  /// Of the box, voxels.
  const VoxelIndex& size() const { return size_; }
  /// Words of a column of a layer.
  int wordsPerColumn() const { return words_; }
  /// Where the words of a column begin within a layer.
  std::int32_t columnOffset(int x, int y) const { return (x * size_.y() + y) * words_; }

  /// Voxel of a bit of a word of a layer.
  VoxelIndex voxelAt(std::int32_t word, int bit) const {
    const std::int32_t column = word / words_;
    return {column / size_.y(), column % size_.y(), word % words_ * kWordBits + bit};
  }

  ///@{
  /// The words of a column.
  std::uint64_t* column(Layer layer, int x, int y) {
    return bits_[layer].data() + columnOffset(x, y);
  }
  const std::uint64_t* column(Layer layer, int x, int y) const {
    return bits_[layer].data() + columnOffset(x, y);
  }
  ///@}
  /// All words of a layer.
  VoxelBits bits(Layer layer) const { return {bits_[layer].data(), size_.y(), words_}; }
  /// Whether a voxel is marked.
  bool test(Layer layer, const VoxelIndex& v) const {
    return (column(layer, v.x(), v.y())[v.z() / kWordBits] >> (v.z() % kWordBits)) & 1u;
  }
  /// Whether a column has any bit.
  bool any(Layer layer, int x, int y) const {
    const std::uint64_t* words = column(layer, x, y);
    return std::any_of(words, words + words_, [](std::uint64_t word) { return word != 0; });
  }
  /// Marks a voxel.
  void mark(Layer layer, const VoxelIndex& v) {
    if (layer != kFree) {
      markEnd(layer, columnOffset(v.x(), v.y()) + v.z() / kWordBits, v.z() % kWordBits);
    } else {
      column(layer, v.x(), v.y())[v.z() / kWordBits] |= std::uint64_t{1} << (v.z() % kWordBits);
    }
  }
  /// Marks a bit of a word of the layers of ends.
  /// \return whether it was not marked before.
  bool markEnd(Layer layer, std::int32_t word, int bit);
  /// Sets the bits z_low..z_high (inclusive, clipped to the box) of a column of the free layer.
  void markFreeRun(std::int32_t column_offset, int z_low, int z_high);

  /// Grows the part of the box that may hold bits; every mark must lie in it.
  void touch(int x, int y);
  /// Columns that may hold bits: [min, max) on x and y.
  const VoxelBox& touched() const { return touched_; }

  /// Memory of the layers now, bytes.
  std::size_t memoryBytes() const {
    return kLayerCount * bits_[kFree].size() * sizeof(std::uint64_t);
  }
  /// Words of a layer over a box of this size (voxels); at most 2^31 - 1 can be addressed.
  static std::int64_t words(const VoxelIndex& size) {
    return VoxelBox{VoxelIndex::Zero(), {size.x(), size.y(), wordsOf(size.z())}}.volume();
  }
  /// Memory of a mask over a box of this size (voxels), bytes.
  static std::int64_t memoryBytes(const VoxelIndex& size) {
    return words(size) * kLayerCount * sizeof(std::uint64_t);
  }

 private:
  static int wordsOf(int height) { return (height + kWordBits - 1) / kWordBits; }

  VoxelBox box_;
  VoxelIndex size_ = VoxelIndex::Zero();
  VoxelBox touched_;
  int words_ = 0;
  std::vector<std::uint64_t> bits_[kLayerCount];
  std::vector<std::int32_t> end_words_;  // with marks of the layers of ends, each at least once
};

inline bool ScanMask::markEnd(Layer layer, std::int32_t word, int bit) {
  std::uint64_t& bits = bits_[layer][word];
  const std::uint64_t mark = std::uint64_t{1} << bit;
  if ((bits & mark) != 0) return false;
  bits |= mark;
  end_words_.push_back(word);
  return true;
}

}  // namespace fiimap
