// Compiled once for each instruction set that Highway knows for this processor family.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "fiimap/bit_column.h"
#include "target_kernels.h"

// Without vectors the plain kernels do.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Bytes = hn::ScalableTag<std::int8_t>;
using Words = hn::ScalableTag<std::uint64_t>;
using HalfInts = hn::Half<Ints>;

using FloatVector = hn::Vec<Floats>;
using IntVector = hn::Vec<Ints>;
using WordVector = hn::Vec<Words>;

/// Whether the machine packs lanes by itself; otherwise Highway looks the order up in a table,
/// which compilers copy at every call.
constexpr bool kPacksLanes = HWY_TARGET <= HWY_AVX3;

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
  std::uint8_t bits[sizeof(std::uint64_t)] = {};
  std::uint64_t mask;
  hn::Store(lanes, d, all);
  hn::StoreMaskBits(d, kept, bits);
  std::memcpy(&mask, bits, sizeof(mask));
  int count = 0;
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) {
    to[count] = all[i];
    count += (mask >> i) & 1u;
  }
  return count;
}

HWY_INLINE IntVector floorToInt(FloatVector value) {
  return hn::ConvertTo(Ints(), hn::Floor(value));
}

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

/// Where the rays to some points end.
struct EndVoxels {
  IntVector x, y, z;
  hn::Mask<Floats> leaving;
};

/// Part of a ray, in voxels, after which it is beyond a face of the box; 1 where it stays inside.
HWY_INLINE FloatVector exitOfSlab(FloatVector origin, FloatVector direction, FloatVector size) {
  const Floats f;
  const auto zero = hn::Zero(f);
  const auto face = hn::IfThenElseZero(hn::Gt(direction, zero), size);
  const auto t = hn::Div(hn::Sub(face, origin), direction);
  return hn::IfThenElse(hn::Ne(direction, zero), t, hn::Set(f, 1.0f));
}

HWY_INLINE EndVoxels endVoxels(const EndPoints& points, int i) {
  const Floats f;
  const Ints d;
  const auto to_voxels = hn::Set(f, points.to_voxels);
  const auto origin_x = hn::Set(f, points.origin[0]);
  const auto origin_y = hn::Set(f, points.origin[1]);
  const auto origin_z = hn::Set(f, points.origin[2]);
  const auto size_x = hn::Set(f, static_cast<float>(points.size[0]));
  const auto size_y = hn::Set(f, static_cast<float>(points.size[1]));
  const auto size_z = hn::Set(f, static_cast<float>(points.size[2]));
  const auto is_inside = [&](FloatVector p, FloatVector size)
                             HWY_ATTR { return hn::And(hn::Ge(p, hn::Zero(f)), hn::Lt(p, size)); };
  const auto x = hn::Add(origin_x, hn::Mul(hn::LoadU(f, points.x + i), to_voxels));
  const auto y = hn::Add(origin_y, hn::Mul(hn::LoadU(f, points.y + i), to_voxels));
  const auto z = hn::Add(origin_z, hn::Mul(hn::LoadU(f, points.z + i), to_voxels));
  const auto inside =
      hn::And(hn::And(is_inside(x, size_x), is_inside(y, size_y)), is_inside(z, size_z));
  EndVoxels ends{hn::ConvertTo(d, x), hn::ConvertTo(d, y), hn::ConvertTo(d, z), hn::Not(inside)};
  if (hn::AllTrue(f, inside)) return ends;

  const auto ray_x = hn::Sub(x, origin_x);
  const auto ray_y = hn::Sub(y, origin_y);
  const auto ray_z = hn::Sub(z, origin_z);
  const auto exit =
      hn::Min(hn::Min(hn::Set(f, 1.0f), exitOfSlab(origin_x, ray_x, size_x)),
              hn::Min(exitOfSlab(origin_y, ray_y, size_y), exitOfSlab(origin_z, ray_z, size_z)));
  const auto last = [&](FloatVector origin, FloatVector ray, std::int32_t size) HWY_ATTR {
    const auto cell = hn::ConvertTo(d, hn::Add(origin, hn::Mul(exit, ray)));
    return hn::Min(hn::Max(cell, hn::Zero(d)), hn::Set(d, size - 1));
  };
  const auto leaving = hn::RebindMask(d, ends.leaving);
  ends.x = hn::IfThenElse(leaving, last(origin_x, ray_x, points.size[0]), ends.x);
  ends.y = hn::IfThenElse(leaving, last(origin_y, ray_y, points.size[1]), ends.y);
  ends.z = hn::IfThenElse(leaving, last(origin_z, ray_z, points.size[2]), ends.z);
  return ends;
}

/// Appends the ends of the rays in `listed`.
HWY_INLINE void appendEnds(const EndPoints& points, const EndVoxels& v, hn::Mask<Ints> listed,
                           RayEnds* ends) {
  const Ints d;
  constexpr int kWordShift = 6;
  static_assert(1 << kWordShift == kWordBits);
  const auto column = hn::Add(hn::Mul(v.x, hn::Set(d, points.size[1])), v.y);
  const auto word = hn::ShiftRight<kWordShift>(v.z);
  const auto offset = hn::Add(hn::Mul(column, hn::Set(d, points.words)), word);
  const auto bit = hn::And(v.z, hn::Set(d, kWordBits - 1));
  const auto leaving = hn::RebindMask(d, v.leaving);
  const auto marked = hn::Or(bit, hn::IfThenElseZero(leaving, hn::Set(d, RayEnds::kLeavesBox)));
  pack(d, offset, listed, ends->offset.data() + ends->size);
  ends->size += pack(d, marked, listed, ends->bit.data() + ends->size);
}

void listEnds(const EndPoints& points, RayEnds* ends) {
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  ends->reserve(points.count);
  ends->size = 0;
  if (points.count == 0) return;
  appendEnds(points, endVoxels(points, 0), hn::FirstN(d, 1), ends);
  for (int i = 1; i < points.count; i += lanes) {
    // The points before are computed again: this is cheaper than to hand lanes over.
    const EndVoxels before = endVoxels(points, i - 1);
    const EndVoxels now = endVoxels(points, i);
    const auto elsewhere =
        hn::Or(hn::Or(hn::Ne(now.x, before.x), hn::Ne(now.y, before.y)), hn::Ne(now.z, before.z));
    const auto leaves_alone = hn::RebindMask(d, hn::Xor(now.leaving, before.leaving));
    const auto changed = hn::Or(elsewhere, leaves_alone);
    const auto listed = hn::And(changed, hn::FirstN(d, std::min(lanes, points.count - i)));
    if (!hn::AllFalse(d, listed)) appendEnds(points, now, listed, ends);
  }
}

/// Border i of the slabs of a line, for consecutive i.
HWY_INLINE FloatVector borderT(const ColumnLine& line, IntVector i) {
  const Floats f;
  const auto distance = hn::Add(hn::Set(f, line.first_border),
                                hn::Mul(hn::ConvertTo(f, i), hn::Set(f, line.major_step)));
  const auto one = hn::Set(f, 1.0f);
  const auto t = hn::Mul(distance, hn::Set(f, line.t_per_major));
  const auto inside = hn::Min(hn::Max(t, hn::Set(f, line.start_t)), one);
  const auto is_end = hn::Eq(i, hn::Set(Ints(), line.slabs));
  return hn::IfThenElse(hn::RebindMask(f, is_end), one, inside);
}

HWY_INLINE IntVector minorCell(const ColumnLine& line, FloatVector t) {
  const Floats f;
  const Ints d;
  const auto minor =
      hn::Add(hn::Set(f, line.minor_origin), hn::Mul(hn::Set(f, line.minor_direction), t));
  const auto cell = hn::ConvertTo(d, minor);
  return hn::Min(hn::Max(cell, hn::Zero(d)), hn::Set(d, line.last_minor_cell));
}

void walk(const ColumnLine& line, ColumnWalk* walk) {
  const Floats f;
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  walk->reserve(line.slabs);
  int size = 0;
  const auto one = hn::Set(d, 1);
  for (int i = 0; i < line.slabs; i += lanes) {
    const auto slab = hn::Iota(d, i);
    const auto t_in = borderT(line, slab);
    const auto t_out = borderT(line, hn::Add(slab, one));
    const auto cell = minorCell(line, t_in);
    const auto next_cell = minorCell(line, t_out);
    const auto first = hn::Add(
        hn::Add(hn::Set(d, line.first_column), hn::Mul(slab, hn::Set(d, line.major_offset))),
        hn::Mul(cell, hn::Set(d, line.minor_offset)));
    const auto second = hn::Add(first, hn::Set(d, line.minor_step * line.minor_offset));
    const auto crossing = hn::Mul(hn::Add(hn::ConvertTo(f, cell), hn::Set(f, line.minor_border)),
                                  hn::Set(f, line.t_per_minor));
    const auto t_second = hn::Min(hn::Max(crossing, t_in), t_out);

    // Both columns of each slab side by side; the second is kept when there is one.
    const auto in_line = hn::Lt(slab, hn::Set(d, line.slabs));
    const auto has_second = hn::And(in_line, hn::Ne(cell, next_cell));
    HWY_ALIGN std::int32_t columns[2 * hn::MaxLanes(Ints())], keep[2 * hn::MaxLanes(Ints())];
    HWY_ALIGN float t[2 * hn::MaxLanes(Floats())];
    hn::StoreInterleaved2(first, second, d, columns);
    hn::StoreInterleaved2(t_in, t_second, f, t);
    hn::StoreInterleaved2(hn::VecFromMask(d, in_line), hn::VecFromMask(d, has_second), d, keep);
    if constexpr (kPacksLanes) {
      for (int half = 0; half < 2 * lanes; half += lanes) {
        const auto kept = hn::MaskFromVec(hn::Load(d, keep + half));
        pack(f, hn::Load(f, t + half), hn::RebindMask(f, kept), walk->t.data() + size);
        size += pack(d, hn::Load(d, columns + half), kept, walk->column.data() + size);
      }
    } else {
      std::int32_t* const walk_column = walk->column.data();
      float* const walk_t = walk->t.data();
      for (int k = 0; k < 2 * lanes; ++k) {
        walk_column[size] = columns[k];
        walk_t[size] = t[k];
        size -= keep[k];  // 0 or -1
      }
    }
  }
  walk->t[size] = 1.0f;
  walk->size = size;
}

/// The words whose bits from[k] to below[k] - 1 are set, for some lanes k.
template <typename Int32Vector>
HWY_INLINE WordVector runMask(Int32Vector from, Int32Vector below) {
  const Words d;
  const hn::RebindToSigned<Words> d64;
  const hn::Rebind<std::int32_t, Words> d32;
  const auto ones = hn::Set(d, ~std::uint64_t{0});
  const auto filled = hn::VecFromMask(d32, hn::Lt(from, below));
  const auto last = hn::Set(d32, kWordBits - 1);
  // Distances of an empty run are anything; keep them valid.
  const auto low = hn::Min(from, last);
  const auto high = hn::Min(hn::Max(hn::Sub(hn::Set(d32, kWordBits), below), hn::Zero(d32)), last);
  const auto shift_low = hn::BitCast(d, hn::PromoteTo(d64, low));
  const auto shift_high = hn::BitCast(d, hn::PromoteTo(d64, high));
  const auto run = hn::And(ones << shift_low, ones >> shift_high);
  return hn::And(run, hn::BitCast(d, hn::PromoteTo(d64, filled)));
}

void freeFan(const FanPart& fan, int height, std::uint64_t* free) {
  const Floats f;
  const Ints d;
  const hn::Half<Ints> half;
  const Words d64;
  constexpr int kMaxLanes = hn::MaxLanes(Ints());
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int first_word = std::max(static_cast<int>(fan.lowest), 0) / kWordBits;
  const int last_word =
      std::min(std::max(static_cast<int>(fan.highest), 0), height - 1) / kWordBits;
  const auto origin_z = hn::Set(f, fan.origin_z);
  const auto rise_low = hn::Set(f, fan.rise_low);
  const auto rise_high = hn::Set(f, fan.rise_high);
  const auto top = hn::Set(d, height - 1);
  HWY_ALIGN std::uint64_t masks[kMaxLanes];

  for (int k = 0; k < fan.columns; k += lanes) {
    const auto t_low = hn::LoadU(f, fan.t_low + k);
    const auto t_high = hn::LoadU(f, fan.t_high + k);
    const auto low = floorToInt(hn::Add(origin_z, hn::Mul(rise_low, t_low)));
    const auto high = floorToInt(hn::Add(origin_z, hn::Mul(rise_high, t_high)));
    const auto end = hn::Add(hn::Min(high, top), hn::Set(d, 1));
    const int count = std::min(lanes, fan.columns - k);
    const std::int32_t* const column = fan.column + k;
    for (int w = first_word; w <= last_word; ++w) {
      const auto base = hn::Set(d, w * kWordBits);
      const auto from = hn::Max(hn::Sub(low, base), hn::Zero(d));
      const auto below = hn::Min(hn::Sub(end, base), hn::Set(d, kWordBits));
      if (hn::AllFalse(d, hn::Lt(from, below))) continue;
      hn::Store(runMask(hn::LowerHalf(half, from), hn::LowerHalf(half, below)), d64, masks);
      hn::Store(runMask(hn::UpperHalf(half, from), hn::UpperHalf(half, below)), d64,
                masks + lanes / 2);
      std::uint64_t* const word = free + w;
      if (count == lanes) {
        for (int j = 0; j < lanes; ++j) word[column[j]] |= masks[j];
      } else {
        for (int j = 0; j < count; ++j) word[column[j]] |= masks[j];
      }
    }
  }
}

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

const TargetKernels kTargetKernels{
    HWY_TARGET, {nullptr, readDepths, projectRow, listEnds, walk, freeFan, observe}};

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace fiimap {
namespace {

/// Those of the machine, best first. Of a machine for which Highway has no vectors, or only those
/// that the compiler uses for plain C++: none.
std::vector<Kernels> vectorKernels() {
  const TargetKernels* const all[] = {HWY_CHOOSE_TARGET_LIST(kTargetKernels)};
  std::vector<Kernels> supported;
  for (const auto* of_target : all) {
    if (of_target == nullptr || (of_target->target & hwy::SupportedTargets()) == 0) continue;
    supported.push_back(of_target->kernels);
    supported.back().name = hwy::TargetName(of_target->target);
  }
  return supported;
}

}  // namespace

std::vector<const Kernels*> availableKernels() {
  static const std::vector<Kernels> vectors = vectorKernels();
  std::vector<const Kernels*> available;
  for (const Kernels& kernels : vectors) available.push_back(&kernels);
  available.push_back(&plainKernels());
  return available;
}

}  // namespace fiimap
#endif  // HWY_ONCE
