#pragma once

// From the ends of rays to what they pass, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

inline void roundRays(const DirectionCube& cube, const RayEnds& ends, const std::int32_t* index,
                      int count, float cut, CubeRays* rays) {
  rays->reserve(count);
  const float half_side = static_cast<float>(cube.half_side);
  const float reach = half_side - DirectionCube::kSlack;
  const float to_cell = half_side + 0.5f;  // of a coordinate in the middle of the cell
  const int last_cell = cube.side() - 1;
  for (int i = 0; i < count; ++i) {
    const std::int32_t k = index[i];
    const std::int32_t z = ends.z[k] & (RayEnds::kLeavesBox - 1);
    const float x = static_cast<float>(ends.x[k]) + 0.5f - cube.origin[0];
    const float y = static_cast<float>(ends.y[k]) + 0.5f - cube.origin[1];
    const float rise = static_cast<float>(z) + 0.5f - cube.origin[2];
    const bool is_x = std::abs(x) >= std::abs(y);
    const float major = is_x ? x : y;
    const float distance = std::abs(major);
    const bool is_rounded = (distance > 0.0f) & (distance <= reach) & (std::abs(rise) <= distance);
    const float to_face = half_side / distance;
    const float length = std::sqrt(x * x + y * y + rise * rise);
    const int face = (is_x ? 0 : 2) + (major < 0.0f ? 1 : 0);
    const auto cellAt = [&](float at) {
      return std::min(std::max(static_cast<int>(at * to_face + to_cell), 0), last_cell);
    };
    rays->slice[i] = CubeRays::kStraight;
    rays->cell[i] = 0;
    rays->reach[i] = distance * (1.0f - cut / length);
    if (!is_rounded) continue;
    rays->slice[i] = face * cube.side() + cellAt(is_x ? y : x);
    rays->cell[i] = cellAt(rise);
  }
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
  border[0] = clamp(line.first_border * line.t_per_major, line.start_t, line.end_t);
  cell[0] = cellAt(border[0]);
  for (int first = 0; first < line.slabs; first += kBlock) {
    const int block = std::min(kBlock, line.slabs - first);
    for (int j = 1; j <= kBlock; ++j) {
      const float distance = line.first_border + static_cast<float>(first + j) * line.major_step;
      border[j] = clamp(distance * line.t_per_major, line.start_t, line.end_t);
    }
    border[block] = first + block == line.slabs ? line.end_t : border[block];
    for (int j = 1; j <= kBlock; ++j) cell[j] = cellAt(border[j]);
    for (int j = 0; j < kBlock; ++j) {
      const float at = (static_cast<float>(cell[j]) + line.minor_border) * line.t_per_minor;
      crossing[j] = clamp(at, border[j], border[j + 1]);
    }
    std::int32_t slab = line.first_column + first * line.major_offset;
    for (int j = 0; j < block; ++j, slab += line.major_offset) {
      walk->first_of_slab[first + j] = k;
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
  t[k] = line.end_t;
  walk->first_of_slab[line.slabs] = k;
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

inline void freeRuns(const RayRuns& part, int height, std::uint64_t* free) {
  for (int k = 0; k < part.columns; ++k) {
    std::uint64_t* const words = free + part.column[k];
    const float t_in = part.t[k];
    const float t_out = part.t[k + 1];
    for (int r = 0; r < part.runs; ++r) {
      const float low = std::min(part.rise_low[r] * t_in, part.rise_low[r] * t_out);
      const float high = std::max(part.rise_high[r] * t_in, part.rise_high[r] * t_out);
      // Truncation is the floor, because negative heights are cut off.
      const int from = static_cast<int>(std::max(part.origin_z + low, 0.0f));
      const int above = static_cast<int>(std::max(part.origin_z + high, -1.0f) + 1.0f);
      const int end = std::min(above, height);
      if (from >= end) continue;
      const int first = from / kWordBits;
      const int last = (end - 1) / kWordBits;
      std::uint64_t mask = kRunMasks.from[from % kWordBits];
      for (int w = first; w < last; ++w) {
        words[w] |= mask;
        mask = ~std::uint64_t{0};
      }
      words[last] |= mask & kRunMasks.below[end - last * kWordBits];
    }
  }
}

}  // namespace fiimap::plain
