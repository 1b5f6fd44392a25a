#include "fiimap/scan_mask.h"

namespace fiimap {

void ScanMask::begin(const VoxelBox& box) {
  for (const std::int32_t word : end_words_) bits_[kHit][word] = bits_[kMissEnd][word] = 0;
  end_words_.clear();
  // Only the columns that the last scan touched can hold bits.
  for (int x = touched_.min.x(); x < touched_.max.x(); ++x) {
    std::fill(column(kFree, x, touched_.min.y()), column(kFree, x, touched_.max.y()), 0);
  }
  box_ = box;
  size_ = box.empty() ? VoxelIndex::Zero() : box.size();
  touched_ = {size_, VoxelIndex::Zero()};
  words_ = wordsOf(size_.z());
  const std::size_t words = static_cast<std::size_t>(size_.x()) * size_.y() * words_;
  for (auto& layer : bits_) {
    if (layer.size() < words) layer.resize(words, 0);
  }
}

void ScanMask::touch(int x, int y) {
  touched_.min = touched_.min.cwiseMin(VoxelIndex(x, y, 0));
  touched_.max = touched_.max.cwiseMax(VoxelIndex(x + 1, y + 1, size_.z()));
}

void ScanMask::markFreeRun(std::int32_t column_offset, int z_low, int z_high) {
  z_low = std::max(z_low, 0);
  z_high = std::min(z_high, size_.z() - 1);
  if (z_low > z_high) return;
  std::uint64_t* const words = bits_[kFree].data() + column_offset;
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
