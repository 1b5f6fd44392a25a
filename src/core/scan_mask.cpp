#include "fiimap/scan_mask.h"

namespace fiimap {

void ScanMask::begin(const VoxelBox& box) {
  // Only the columns that the last scan touched can hold bits.
  for (int x = touched_.min.x(); x < touched_.max.x(); ++x) {
    for (auto& layer : bits_) {
      const std::size_t first = columnIndex(x, touched_.min.y()) * words_;
      const std::size_t last = columnIndex(x, touched_.max.y()) * words_;
      std::fill(layer.begin() + first, layer.begin() + last, 0);
    }
  }
  box_ = box;
  size_ = box.empty() ? VoxelIndex::Zero() : box.size();
  touched_ = {size_, VoxelIndex::Zero()};
  words_ = (size_.z() + kWordBits - 1) / kWordBits;
  const std::size_t words = static_cast<std::size_t>(size_.x()) * size_.y() * words_;
  for (auto& layer : bits_) {
    if (layer.size() < words) layer.resize(words, 0);
  }
}

void ScanMask::touch(int x, int y) {
  touched_.min = touched_.min.cwiseMin(VoxelIndex(x, y, 0));
  touched_.max = touched_.max.cwiseMax(VoxelIndex(x + 1, y + 1, size_.z()));
}

}  // namespace fiimap
