#pragma once

// From what rays hit and pass to log-odds, in plain C++ that compilers turn into vectors.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "plain_blocks.h"

namespace fiimap::plain {

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

inline std::uint64_t repeat(std::int8_t value) {
  return kEveryByte * static_cast<std::uint8_t>(value);
}

inline void observeGroup(const LogOdds& l, std::uint8_t hit, std::uint8_t free, std::uint8_t known,
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

inline void observe(const LogOdds& l, int words, const std::uint64_t* hit,
                    const std::uint64_t* free, const std::uint64_t* known, std::uint64_t* occupied,
                    std::int8_t* log_odds) {
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

}  // namespace fiimap::plain
