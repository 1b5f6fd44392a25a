#pragma once

#include <cstdint>

namespace fiimap {

// A bit column is an array of 64-bit words; bit i of word w stands for voxel 64 w + i of a
// z-column.

///@{
/// Bits of a word, and the shift that divides by them.
constexpr int kWordShift = 6;
constexpr int kWordBits = 1 << kWordShift;
///@}

/// Number of set bits. In sums of ever more bits, because without an instruction for it compilers
/// call a function that looks up each byte.
inline int countBits(std::uint64_t word) {
  word -= (word >> 1) & 0x5555555555555555u;                                  // of each 2 bits
  word = (word & 0x3333333333333333u) + ((word >> 2) & 0x3333333333333333u);  // of each 4 bits
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;                          // of each byte
  return static_cast<int>((word * 0x0101010101010101u) >> (kWordBits - 8));   // the sum is on top
}

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
