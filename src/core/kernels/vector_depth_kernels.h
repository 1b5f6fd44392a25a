// From depth images to points, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_DEPTH_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_DEPTH_KERNELS_H
#undef FIIMAP_VECTOR_DEPTH_KERNELS_H
#else
#define FIIMAP_VECTOR_DEPTH_KERNELS_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fiimap/kernels.h"
#include "vectors.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

void readDepths(const std::uint8_t* pixels, int step, int samples, float scale, float* depth) {
  const Ints d;
  const Floats f;
  const hn::RebindToUnsigned<Ints> u;
  const hn::Rebind<std::uint16_t, Ints> u16;
  constexpr std::uint16_t kSaturated = 0xffff;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto nan = hn::NaN(f);
  const auto zero = hn::Zero(u);
  const auto saturated = hn::Set(u, kSaturated);
  const auto metres = [&](hn::Vec<decltype(u)> value) HWY_ATTR {
    const auto invalid = hn::Or(hn::Eq(value, zero), hn::Eq(value, saturated));
    const auto scaled = hn::Mul(hn::ConvertTo(f, hn::BitCast(d, value)), hn::Set(f, scale));
    return hn::IfThenElse(hn::RebindMask(f, invalid), nan, scaled);
  };
  int i = 0;
  if (step == 1) {
    for (; i + lanes <= samples; i += lanes) {
      const auto* const values = reinterpret_cast<const std::uint16_t*>(pixels) + i;
      hn::StoreU(metres(hn::PromoteTo(u, hn::LoadU(u16, values))), f, depth + i);
    }
  } else if (step == 2) {
    // Pairs of pixels, of which the first is the low half; not the last pixel, which may have none
    // beside it.
    for (; i + lanes < samples; i += lanes) {
      const auto* const pairs = reinterpret_cast<const std::uint32_t*>(pixels) + i;
      hn::StoreU(metres(hn::And(hn::LoadU(u, pairs), saturated)), f, depth + i);
    }
  }
  plainKernels().readDepths(pixels + static_cast<std::size_t>(i) * step * sizeof(std::uint16_t),
                            step, samples - i, scale, depth + i);
}

RowCount projectRow(const DepthRow& row, bool list_invalid, float* x, float* y, float* z,
                    std::int32_t* others) {
  const Floats f;
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(f));
  RowCount count;
  const auto unlisted = list_invalid ? hn::FirstN(f, 0) : hn::FirstN(f, lanes);
  for (int i = 0; i < row.samples; i += lanes) {
    const auto in_row = hn::FirstN(f, std::min(lanes, row.samples - i));
    const auto depth = hn::LoadU(f, row.depth + i);
    const auto ray_length_2 = hn::Add(hn::LoadU(f, row.length_2 + i), hn::Set(f, row.row_length_2));
    const auto length_2 = hn::Mul(hn::Mul(depth, depth), ray_length_2);
    const auto in_depth =
        hn::And(hn::Ge(depth, hn::Set(f, row.min_depth)), hn::Le(depth, hn::Set(f, row.max_depth)));
    const auto in_length = hn::And(hn::Ge(length_2, hn::Set(f, row.min_length_2)),
                                   hn::Le(length_2, hn::Set(f, row.max_length_2)));
    const auto is_return = hn::And(in_row, hn::And(in_depth, in_length));
    const auto ray_x = hn::Add(hn::LoadU(f, row.ray_x + i), hn::Set(f, row.row_x));
    const auto ray_y = hn::Add(hn::LoadU(f, row.ray_y + i), hn::Set(f, row.row_y));
    const auto ray_z = hn::Add(hn::LoadU(f, row.ray_z + i), hn::Set(f, row.row_z));
    if (hn::AllTrue(f, is_return)) {
      hn::StoreU(hn::Mul(ray_x, depth), f, x + count.returns);
      hn::StoreU(hn::Mul(ray_y, depth), f, y + count.returns);
      hn::StoreU(hn::Mul(ray_z, depth), f, z + count.returns);
      count.returns += lanes;
      continue;
    }
    const auto is_unlisted = hn::And(unlisted, hn::IsNaN(depth));
    const auto is_other = hn::AndNot(hn::Or(is_return, is_unlisted), in_row);
    if (!hn::AllFalse(f, is_other)) {
      count.others += pack(d, hn::Iota(d, i), hn::RebindMask(d, is_other), others + count.others);
    }
    if (hn::AllFalse(f, is_return)) continue;
    pack(f, hn::Mul(ray_x, depth), is_return, x + count.returns);
    pack(f, hn::Mul(ray_y, depth), is_return, y + count.returns);
    count.returns += pack(f, hn::Mul(ray_z, depth), is_return, z + count.returns);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
