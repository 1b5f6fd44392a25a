// From what rays hit and pass to log-odds, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_FUSION_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_FUSION_KERNELS_H
#undef FIIMAP_VECTOR_FUSION_KERNELS_H
#else
#define FIIMAP_VECTOR_FUSION_KERNELS_H
#endif

#include <cstdint>
#include <cstring>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "vectors.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

void observe(const LogOdds& l, int words, const std::uint64_t* hit, const std::uint64_t* free,
             const std::uint64_t* known, std::uint64_t* occupied, std::int8_t* log_odds) {
  const hn::CappedTag<std::int8_t, kWordBits> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int lane_bytes = lanes / 8;
  const auto hit_step = hn::Set(d, l.hit);
  const auto miss_step = hn::Set(d, l.miss);
  const auto min = hn::Set(d, l.min);
  const auto max = hn::Set(d, l.max);
  const auto below_threshold = hn::Set(d, static_cast<std::int8_t>(l.threshold - 1));
  for (int w = 0; w < words; ++w) {
    const std::uint64_t observed_word = hit[w] | free[w];
    if (observed_word == 0) continue;
    std::uint8_t hit_bits[8], observed_bits[8], known_bits[8], above_bits[8];
    std::memcpy(hit_bits, hit + w, sizeof(hit_bits));
    std::memcpy(observed_bits, &observed_word, sizeof(observed_bits));
    std::memcpy(known_bits, known + w, sizeof(known_bits));
    for (int i = 0; i < kWordBits / lanes; ++i) {
      const int byte = i * lane_bytes;
      std::int8_t* const values = log_odds + w * kWordBits + i * lanes;
      const auto is_hit = hn::LoadMaskBits(d, hit_bits + byte);
      const auto is_observed = hn::LoadMaskBits(d, observed_bits + byte);
      const auto is_known = hn::LoadMaskBits(d, known_bits + byte);
      const auto stored = hn::LoadU(d, values);
      const auto before = hn::IfThenElseZero(is_known, stored);
      const auto step = hn::IfThenElse(is_hit, hit_step, miss_step);
      const auto sum = hn::Min(hn::Max(hn::SaturatedAdd(before, step), min), max);
      const auto after = hn::IfThenElse(is_observed, sum, stored);
      // Mostly nothing changes: free voxels are as certainly free as can be.
      if (!hn::AllTrue(d, hn::Eq(after, stored))) hn::StoreU(after, d, values);
      hn::StoreMaskBits(d, hn::Gt(after, below_threshold), above_bits + byte);
    }
    std::uint64_t above;
    std::memcpy(&above, above_bits, sizeof(above));
    occupied[w] = (occupied[w] & ~observed_word) | (above & observed_word);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
