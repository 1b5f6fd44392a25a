// Names and small tools that the vector kernels share.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTORS_H
#undef FIIMAP_VECTORS_H
#else
#define FIIMAP_VECTORS_H
#endif

#include <cstdint>
#include <cstring>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Words = hn::ScalableTag<std::uint64_t>;

using FloatVector = hn::Vec<Floats>;
using IntVector = hn::Vec<Ints>;
using WordVector = hn::Vec<Words>;

/// Whether the machine packs lanes by itself; otherwise Highway looks the order up in a table,
/// which compilers copy at every call.
constexpr bool kPacksLanes = HWY_TARGET <= HWY_AVX3;

/// Whether the machine gathers lanes from memory by itself.
constexpr bool kGathers = HWY_TARGET <= HWY_AVX2;

/// Bit i: lane i is in the mask.
template <typename D, typename M>
HWY_INLINE std::uint64_t maskBits(D d, M mask) {
  std::uint8_t bytes[sizeof(std::uint64_t)] = {};
  std::uint64_t bits;
  hn::StoreMaskBits(d, mask, bytes);
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits;
}

/// Writes the lanes in `kept` side by side, and maybe whole vectors.
/// \return how many.
template <typename D, typename V, typename M>
HWY_INLINE int pack(D d, V lanes, M kept, hn::TFromD<D>* to) {
  if constexpr (kPacksLanes) {
    hn::StoreU(hn::Compress(lanes, kept), d, to);
    return static_cast<int>(hn::CountTrue(d, kept));
  }
  constexpr int kMaxLanes = hn::MaxLanes(D());
  HWY_ALIGN hn::TFromD<D> all[kMaxLanes];
  hn::Store(lanes, d, all);
  const std::uint64_t mask = maskBits(d, kept);
  int count = 0;
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) {
    to[count] = all[i];
    count += (mask >> i) & 1u;
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
