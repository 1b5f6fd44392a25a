#pragma once

// From points to what rays hit and pass, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <array>
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
  ends->reserve(points.count);
  ends->size = 0;
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
      ends->column[ends->size] = (v[0] * points.size[1] + v[1]) * points.words;
      ends->z[ends->size] = v[2] + (leaves ? RayEnds::kLeavesBox : 0);
      ends->first[ends->size] = first + j;
      ++ends->size;
    }
  }
  ends->first[ends->size] = points.count;
}

inline void walk(const ColumnLine& line, ColumnWalk* walk) {
  walk->reserve(line.slabs);
  std::int32_t* const column = walk->column.data();
  float* const t = walk->t.data();
  const std::int32_t second_offset = line.minor_step * line.minor_offset;
  float border[kBlock + 1], crossing[kBlock];
  std::int32_t cell[kBlock + 1];
  const auto cellAt = [&](float at) {
    const auto minor = static_cast<std::int32_t>(line.minor_origin + line.minor_direction * at);
    return std::min(std::max(minor, 0), line.last_minor_cell);
  };
  int k = 0;
  border[0] = clamp(line.first_border * line.t_per_major, line.start_t, 1.0f);
  cell[0] = cellAt(border[0]);
  for (int first = 0; first < line.slabs; first += kBlock) {
    const int block = std::min(kBlock, line.slabs - first);
    for (int j = 1; j <= kBlock; ++j) {
      const float distance = line.first_border + static_cast<float>(first + j) * line.major_step;
      border[j] = clamp(distance * line.t_per_major, line.start_t, 1.0f);
    }
    border[block] = first + block == line.slabs ? 1.0f : border[block];
    for (int j = 1; j <= kBlock; ++j) cell[j] = cellAt(border[j]);
    for (int j = 0; j < kBlock; ++j) {
      const float at = (static_cast<float>(cell[j]) + line.minor_border) * line.t_per_minor;
      crossing[j] = clamp(at, border[j], border[j + 1]);
    }
    std::int32_t slab = line.first_column + first * line.major_offset;
    for (int j = 0; j < block; ++j, slab += line.major_offset) {
      // Both columns of the slab are written; the second is kept when there is one.
      const std::int32_t first_of_slab = slab + cell[j] * line.minor_offset;
      column[k] = first_of_slab;
      column[k + 1] = first_of_slab + second_offset;
      t[k] = border[j];
      t[k + 1] = crossing[j];
      k += cell[j] != cell[j + 1] ? 2 : 1;
    }
    border[0] = border[kBlock];
    cell[0] = cell[kBlock];
  }
  t[k] = 1.0f;
  walk->size = k;
}

/// Words with the bits from i on, and below i, for i = 0..64: shifts by a variable distance are
/// slow without BMI2.
struct RunMasks {
  std::array<std::uint64_t, kWordBits + 1> from{}, below{};
};

constexpr RunMasks makeRunMasks() {
  RunMasks masks;
  for (int i = 0; i < kWordBits; ++i) {
    masks.from[i] = ~std::uint64_t{0} << i;
    masks.below[i] = ~masks.from[i];
  }
  masks.below[kWordBits] = ~std::uint64_t{0};
  return masks;
}

constexpr RunMasks kRunMasks = makeRunMasks();

inline void freeFan(const FanPart& fan, int height, std::uint64_t* free) {
  const int first_word = std::max(static_cast<int>(fan.lowest), 0) / kWordBits;
  const int last_word =
      std::min(std::max(static_cast<int>(fan.highest), 0), height - 1) / kWordBits;
  // Truncation is the floor, because negative heights are cut off.
  const float origin_low = fan.origin_z;
  const float origin_end = fan.origin_z + 1.0f;
  const float rise_low = fan.rise_low;
  const float rise_high = fan.rise_high;
  std::int32_t low[kBlock], end[kBlock];
  for (int first = 0; first < fan.columns; first += kBlock) {
    const int count = std::min(kBlock, fan.columns - first);
    const float* const t_low = fan.t_low + first;
    const float* const t_high = fan.t_high + first;
    const std::int32_t* const column = fan.column + first;
    for (int k = 0; k < kBlock; ++k) {
      low[k] = static_cast<std::int32_t>(std::max(origin_low + rise_low * t_low[k], 0.0f));
    }
    for (int k = 0; k < kBlock; ++k) {
      const auto above =
          static_cast<std::int32_t>(std::max(origin_end + rise_high * t_high[k], 0.0f));
      end[k] = std::min(above, height);
    }
    for (int w = first_word; w <= last_word; ++w) {
      std::uint64_t* const word = free + w;
      const int base = w * kWordBits;
      if (first_word == last_word && base == 0) {
        for (int k = 0; k < count; ++k) {
          if (low[k] < end[k]) word[column[k]] |= kRunMasks.from[low[k]] & kRunMasks.below[end[k]];
        }
        break;
      }
      for (int k = 0; k < count; ++k) {
        const int from = std::max(low[k] - base, 0);
        const int below = std::min(end[k] - base, kWordBits);
        if (from < below) word[column[k]] |= kRunMasks.from[from] & kRunMasks.below[below];
      }
    }
  }
}

}  // namespace fiimap::plain
