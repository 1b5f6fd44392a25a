#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"

namespace fiimap {
namespace {

inline float clamp(float value, float low, float high) {
  return std::min(std::max(value, low), high);
}

/// Long enough that compilers keep loops over it, which they vectorize, instead of unrolling them.
constexpr int kBlock = 32;
constexpr int kGroup = 8;  // that are mostly alike

template <int Step>
void readDepthsAtStep(const std::uint8_t* pixels, int step, int samples, float scale,
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

void readDepths(const std::uint8_t* pixels, int step, int samples, float scale, float* depth) {
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
RowCount projectRow(const DepthRow& row, bool list_invalid, float* x, float* y, float* z,
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

/// Part of the ray from the origin to p, both in voxels, after which it leaves the box.
float exitOfBox(const EndPoints& points, const float* p) {
  float exit = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float direction = p[axis] - points.origin[axis];
    const float face = direction > 0.0f ? static_cast<float>(points.size[axis]) : 0.0f;
    const float t = (face - points.origin[axis]) / direction;
    exit = direction != 0.0f ? std::min(exit, t) : exit;
  }
  return exit;
}

void listEnds(const EndPoints& points, RayEnds* ends) {
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
      ++ends->size;
    }
  }
}

void walk(const ColumnLine& line, ColumnWalk* walk) {
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

void freeFan(const FanPart& fan, int height, std::uint64_t* free) {
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

// Fusion treats a group of voxels at a time: the bytes of a 64-bit word.
constexpr std::uint64_t kEveryByte = 0x0101010101010101;

/// 0xff where a bit of the index is set.
constexpr std::array<std::uint64_t, 256> makeByteMasks() {
  std::array<std::uint64_t, 256> masks{};
  for (int value = 0; value < 256; ++value) {
    for (int bit = 0; bit < kGroup; ++bit) {
      if ((value >> bit) & 1) masks[value] |= std::uint64_t{0xff} << (8 * bit);
    }
  }
  return masks;
}

constexpr std::array<std::uint64_t, 256> kByteMasks = makeByteMasks();

std::uint64_t repeat(std::int8_t value) { return kEveryByte * static_cast<std::uint8_t>(value); }

void observeGroup(const LogOdds& l, std::uint8_t hit, std::uint8_t free, std::uint8_t known,
                  std::int8_t* log_odds, std::uint8_t* occupied) {
  std::uint64_t before;
  std::memcpy(&before, log_odds, kGroup);
  before &= kByteMasks[known];
  const std::uint8_t observed = hit | free;
  const std::uint64_t observed_bytes = kByteMasks[observed];
  // Most voxels that a scan sees are known to be free and as certainly so as can be: another miss
  // changes nothing.
  const bool all_misses_of_known_voxels = hit == 0 && (observed & ~known) == 0;
  if (all_misses_of_known_voxels && ((before ^ repeat(l.min)) & observed_bytes) == 0) return;

  const std::uint64_t hit_bytes = kByteMasks[hit];
  std::int8_t value[kGroup], is_hit[kGroup], is_observed[kGroup];
  std::memcpy(value, &before, kGroup);
  std::memcpy(is_hit, &hit_bytes, kGroup);
  std::memcpy(is_observed, &observed_bytes, kGroup);
  std::uint8_t above = 0;
  for (int i = 0; i < kGroup; ++i) {
    const int change = is_hit[i] != 0 ? l.hit : l.miss;
    const int after = std::clamp<int>(value[i] + change, l.min, l.max);
    value[i] = static_cast<std::int8_t>(is_observed[i] != 0 ? after : value[i]);
    above |= static_cast<std::uint8_t>((value[i] >= l.threshold ? 1 : 0) << i);
  }
  std::memcpy(log_odds, value, kGroup);
  *occupied = static_cast<std::uint8_t>((*occupied & ~observed) | (above & observed));
}

void observe(const LogOdds& l, int words, const std::uint64_t* hit, const std::uint64_t* free,
             const std::uint64_t* known, std::uint64_t* occupied, std::int8_t* log_odds) {
  for (int w = 0; w < words; ++w) {
    const std::uint64_t observed = hit[w] | free[w];
    for (int shift = 0; shift < kWordBits; shift += kGroup) {
      if (((observed >> shift) & 0xff) == 0) continue;
      std::uint8_t group = occupied[w] >> shift;
      observeGroup(l, hit[w] >> shift, free[w] >> shift, known[w] >> shift,
                   log_odds + w * kWordBits + shift, &group);
      occupied[w] &= ~(std::uint64_t{0xff} << shift);
      occupied[w] |= std::uint64_t{group} << shift;
    }
  }
}

}  // namespace

const Kernels& plainKernels() {
  static const Kernels kernels{"plain", readDepths, projectRow, listEnds, walk, freeFan, observe};
  return kernels;
}

}  // namespace fiimap
