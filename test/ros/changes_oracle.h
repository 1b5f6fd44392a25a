#pragma once

#include <fiimap/MapChanges.h>
#include <zlib.h>

#include <cstdint>
#include <iterator>
#include <vector>

#include "../core/oracle.h"

namespace fiimap::test {

/// A zlib stream of bytes, and its bytes.
inline std::vector<std::uint8_t> zlibStream(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> stream(size);
  compress(stream.data(), &size, bytes.data(), bytes.size());
  stream.resize(size);
  return stream;
}
inline std::vector<std::uint8_t> bytesOfZlib(const std::vector<std::uint8_t>& stream) {
  std::vector<std::uint8_t> bytes(1);
  uLongf size = 1;
  while (uncompress(bytes.data(), &size, stream.data(), stream.size()) == Z_BUF_ERROR) {
    bytes.resize(2 * bytes.size());
    size = bytes.size();
  }
  bytes.resize(size);
  return bytes;
}

/// What MapChanges.msg says, one voxel at a time.
class ChangesOracle {
 public:
  ChangesOracle() = default;
  explicit ChangesOracle(const VoxelSet& occupied) : occupied_(occupied) {}

  /// \param message that is valid and follows the one before.
  void apply(const MapChanges& message) {
    if (message.previous == 0) occupied_.clear();
    window_ = {VoxelIndex(message.window_min[0], message.window_min[1], message.window_min[2]),
               VoxelIndex(message.window_max[0], message.window_max[1], message.window_max[2])};
    for (auto v = occupied_.begin(); v != occupied_.end();) {
      v = window_.contains(*v) ? std::next(v) : occupied_.erase(v);
    }
    std::int64_t place = 0;
    bool changes = false;
    for (const std::int64_t length :
         numbersIn(message.changes.empty() ? message.changes : bytesOfZlib(message.changes))) {
      for (std::int64_t end = place + length; place < end; ++place) {
        if (changes) flip(voxelAt(place));
      }
      changes = !changes;
    }
  }

  const VoxelBox& window() const { return window_; }
  const VoxelSet& occupied() const { return occupied_; }
  VoxelField inflated(const ElementDefinition& element) const {
    return dilate(occupied_, element.offsets(), window_);
  }

 private:
  static std::vector<std::int64_t> numbersIn(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::int64_t> numbers;
    std::int64_t number = 0, weight = 1;
    for (const std::uint8_t byte : bytes) {
      number += byte % 128 * weight;
      weight *= 128;
      if (byte >= 128) continue;
      numbers.push_back(number);
      number = 0, weight = 1;
    }
    return numbers;
  }

  VoxelIndex voxelAt(std::int64_t place) const {
    const VoxelIndex size = window_.size();
    const auto z = static_cast<int>(place % size.z());
    const auto y = static_cast<int>(place / size.z() % size.y());
    const auto x = static_cast<int>(place / size.z() / size.y());
    return window_.min + VoxelIndex(x, y, z);
  }

  void flip(const VoxelIndex& v) {
    if (occupied_.erase(v) == 0) occupied_.insert(v);
  }

  VoxelBox window_;
  VoxelSet occupied_;
};

}  // namespace fiimap::test
