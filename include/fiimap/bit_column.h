#pragma once

#include <cstdint>

namespace fiimap {

// A bit column is an array of 64-bit words; bit i of word w stands for voxel 64 w + i of a
// z-column.

constexpr int kWordShift = 6;
constexpr int kWordBits = 1 << kWordShift;

/// Calls visit(bit) for every set bit of a column, lowest first.
template <typename Visitor>
void forEachBit(const std::uint64_t* words, int count, Visitor&& visit) {
  for (int w = 0; w < count; ++w) {
    for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1) {
      visit(w * kWordBits + __builtin_ctzll(rest));
    }
  }
}

/// Calls visit(first, last) for every run of set bits of a column, lowest first.
template <typename Visitor>
void forEachRun(const std::uint64_t* words, int count, Visitor&& visit) {
  int run_start = -1;
  for (int w = 0; w < count; ++w) {
    // Bits at which a run starts or ends: where a bit differs from the one below it.
    const std::uint64_t below = (words[w] << 1) | (run_start >= 0 ? 1u : 0u);
    for (std::uint64_t edges = words[w] ^ below; edges != 0; edges &= edges - 1) {
      const int bit = w * kWordBits + __builtin_ctzll(edges);
      if (run_start < 0) {
        run_start = bit;
      } else {
        visit(run_start, bit - 1);
        run_start = -1;
      }
    }
  }
  if (run_start >= 0) visit(run_start, count * kWordBits - 1);
}

}  // namespace fiimap
