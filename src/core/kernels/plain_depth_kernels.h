#pragma once

// From pixels to points, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

template <int Step>
inline void readDepthsAtStep(const std::uint8_t* pixels, int step, int samples, float scale,
                             float* depth) {
  const int stride = Step > 0 ? Step : step;
  for (int i = 0; i < samples; ++i) {
    std::uint16_t value;
    std::memcpy(&value, pixels + static_cast<std::size_t>(i) * stride * sizeof(value),
                sizeof(value));
    // 65535 is what drivers write for "saturated".
    const bool valid = value != 0 && value != std::numeric_limits<std::uint16_t>::max();
    depth[i] = valid ? static_cast<float>(value) * scale : std::numeric_limits<float>::quiet_NaN();
  }
}

inline void readDepths(const std::uint8_t* pixels, int step, int samples, float scale,
                       float* depth) {
  switch (step) {
    case 1:
      return readDepthsAtStep<1>(pixels, step, samples, scale, depth);
    case 2:
      return readDepthsAtStep<2>(pixels, step, samples, scale, depth);
    default:
      return readDepthsAtStep<0>(pixels, step, samples, scale, depth);
  }
}

/// Neighbouring pixels are mostly of one kind: a block of returns needs no decision per pixel and
/// becomes vector instructions, for which its length and its own memory are fixed.
inline RowCount projectRow(const DepthRow& row, bool list_invalid, float* x, float* y, float* z,
                           std::int32_t* others) {
  RowCount count;
  for (int first = 0; first < row.samples; first += kBlock) {
    const int block = std::min(kBlock, row.samples - first);
    std::int32_t is_return[kBlock];
    float points[3][kBlock];
    for (int j = 0; j < kBlock; ++j) {
      const int i = first + j;
      const float depth = row.depth[i];
      const float length_2 = depth * depth * (row.length_2[i] + row.row_length_2);
      is_return[j] = (depth >= row.min_depth) & (depth <= row.max_depth) &
                     (length_2 >= row.min_length_2) & (length_2 <= row.max_length_2) & (j < block);
      points[0][j] = (row.ray_x[i] + row.row_x) * depth;
      points[1][j] = (row.ray_y[i] + row.row_y) * depth;
      points[2][j] = (row.ray_z[i] + row.row_z) * depth;
    }
    for (int group = 0; group < block; group += kGroup) {
      int in_group = 0;
      for (int j = group; j < group + kGroup; ++j) in_group += is_return[j];
      if (in_group == kGroup) {
        std::copy_n(points[0] + group, kGroup, x + count.returns);
        std::copy_n(points[1] + group, kGroup, y + count.returns);
        std::copy_n(points[2] + group, kGroup, z + count.returns);
        count.returns += kGroup;
        continue;
      }
      for (int j = group; j < std::min(group + kGroup, block); ++j) {
        x[count.returns] = points[0][j];
        y[count.returns] = points[1][j];
        z[count.returns] = points[2][j];
        count.returns += is_return[j];
        others[count.others] = first + j;
        const bool is_valid = row.depth[first + j] == row.depth[first + j];
        count.others += (1 - is_return[j]) & (list_invalid || is_valid ? 1 : 0);
      }
    }
  }
  return count;
}

}  // namespace fiimap::plain
