#pragma once

// From points to the voxels in which rays end, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <cstdint>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

/// Part of the ray from the origin to p, both in voxels, after which it leaves the box.
inline float exitOfBox(const EndPoints& points, const float* p) {
  float exit = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float direction = p[axis] - points.origin[axis];
    const float face = direction > 0.0f ? static_cast<float>(points.size[axis]) : 0.0f;
    const float t = (face - points.origin[axis]) / direction;
    exit = direction != 0.0f ? std::min(exit, t) : exit;
  }
  return exit;
}

inline void listEnds(const EndPoints& points, RayEnds* ends) {
  constexpr std::int32_t kNone = -1;
  const float* const offset[3] = {points.x, points.y, points.z};
  ends->begin(points.count);
  float p[3][kBlock];
  // The voxel of the last point of the block before, then those of the block; kNone: outside.
  std::int32_t voxel[3][kBlock + 1] = {{kNone}, {kNone}, {kNone}};
  std::int32_t changed[kBlock];
  for (int first = 0; first < points.count; first += kBlock) {
    const int block = std::min(kBlock, points.count - first);
    for (int j = 0; j < kBlock; ++j) changed[j] = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float size = static_cast<float>(points.size[axis]);
      for (int j = 0; j < kBlock; ++j) {
        p[axis][j] = points.origin[axis] + offset[axis][first + j] * points.to_voxels;
        const bool inside = (p[axis][j] >= 0.0f) & (p[axis][j] < size);
        voxel[axis][j + 1] = inside ? static_cast<std::int32_t>(p[axis][j]) : kNone;
      }
      for (int j = 0; j < kBlock; ++j) {
        changed[j] |= (voxel[axis][j + 1] ^ voxel[axis][j]) | (voxel[axis][j + 1] >> 31);
      }
      voxel[axis][0] = voxel[axis][kBlock];
    }
    for (int j = 0; j < block; ++j) {
      if (changed[j] == 0) continue;
      std::int32_t v[3] = {voxel[0][j + 1], voxel[1][j + 1], voxel[2][j + 1]};
      const bool leaves = (v[0] | v[1] | v[2]) < 0;
      if (leaves) {
        const float end[3] = {p[0][j], p[1][j], p[2][j]};
        const float exit = exitOfBox(points, end);
        for (int axis = 0; axis < 3; ++axis) {
          const float at = points.origin[axis] + exit * (end[axis] - points.origin[axis]);
          v[axis] = std::clamp(static_cast<std::int32_t>(at), 0, points.size[axis] - 1);
        }
      }
      for (int axis = 0; axis < 2; ++axis) {
        ends->low[axis] = std::min(ends->low[axis], v[axis]);
        ends->high[axis] = std::max(ends->high[axis], v[axis]);
      }
      ends->x[ends->size] = v[0];
      ends->y[ends->size] = v[1];
      ends->z[ends->size] = v[2] + (leaves ? RayEnds::kLeavesBox : 0);
      ends->first[ends->size] = first + j;
      ++ends->size;
    }
  }
  ends->first[ends->size] = points.count;
}

/// Without a branch, which would be guessed wrong often.
inline int selectEnds(const RayEnds& ends, int first, int last, const VoxelBits& bits, bool value,
                      std::int32_t* listed) {
  int count = 0;
  for (int k = first; k < last; ++k) {
    const auto z = static_cast<std::uint32_t>(ends.z[k]) % RayEnds::kLeavesBox;
    const std::int32_t column = (ends.x[k] * bits.size_y + ends.y[k]) * bits.words_per_column;
    const std::uint64_t bit = bits.words[column + z / kWordBits] >> (z % kWordBits) & 1u;
    const bool is_set = bit != 0 && ends.z[k] < RayEnds::kLeavesBox;
    listed[count] = k;
    count += is_set == value ? 1 : 0;
  }
  return count;
}

}  // namespace fiimap::plain
