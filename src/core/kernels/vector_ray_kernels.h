// From points to what rays hit and pass, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_RAY_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_RAY_KERNELS_H
#undef FIIMAP_VECTOR_RAY_KERNELS_H
#else
#define FIIMAP_VECTOR_RAY_KERNELS_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fiimap/bit_column.h"
#include "fiimap/kernels.h"
#include "vectors.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

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

/// Appends the ends of the rays in `listed`, of those from `first` on.
HWY_INLINE void appendEnds(const EndPoints& points, const EndVoxels& v, int first,
                           hn::Mask<Ints> listed, RayEnds* ends) {
  const Ints d;
  const auto index = hn::Add(hn::Mul(v.x, hn::Set(d, points.size[1])), v.y);
  const auto column = hn::Mul(index, hn::Set(d, points.words));
  const auto leaving = hn::RebindMask(d, v.leaving);
  const auto z = hn::Or(v.z, hn::IfThenElseZero(leaving, hn::Set(d, RayEnds::kLeavesBox)));
  pack(d, column, listed, ends->column.data() + ends->size);
  pack(d, hn::Iota(d, first), listed, ends->first.data() + ends->size);
  ends->size += pack(d, z, listed, ends->z.data() + ends->size);
}

void listEnds(const EndPoints& points, RayEnds* ends) {
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  ends->reserve(points.count);
  ends->size = 0;
  if (points.count == 0) {
    ends->first[0] = 0;
    return;
  }
  appendEnds(points, endVoxels(points, 0), 0, hn::FirstN(d, 1), ends);
  for (int i = 1; i < points.count; i += lanes) {
    // The points before are computed again: this is cheaper than to hand lanes over.
    const EndVoxels before = endVoxels(points, i - 1);
    const EndVoxels now = endVoxels(points, i);
    const auto elsewhere =
        hn::Or(hn::Or(hn::Ne(now.x, before.x), hn::Ne(now.y, before.y)), hn::Ne(now.z, before.z));
    const auto leaves_alone = hn::RebindMask(d, hn::Xor(now.leaving, before.leaving));
    const auto changed = hn::Or(elsewhere, leaves_alone);
    const auto listed = hn::And(changed, hn::FirstN(d, std::min(lanes, points.count - i)));
    if (!hn::AllFalse(d, listed)) appendEnds(points, now, i, listed, ends);
  }
  ends->first[ends->size] = points.count;
}

void walk(const ColumnLine& line, ColumnWalk* walk) {
  const Floats f;
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  walk->reserve(line.slabs);
  std::int32_t* const walk_column = walk->column.data();
  float* const walk_t = walk->t.data();
  const std::int32_t second_offset = line.minor_step * line.minor_offset;
  const int slabs = line.slabs;

  // Out of the loop by hand: for all that the compiler knows, what it writes could be `line`.
  const auto one = hn::Set(f, 1.0f);
  const auto first_border = hn::Set(f, line.first_border);
  const auto major_step = hn::Set(f, line.major_step);
  const auto t_per_major = hn::Set(f, line.t_per_major);
  const auto start_t = hn::Set(f, line.start_t);
  const auto minor_origin = hn::Set(f, line.minor_origin);
  const auto minor_direction = hn::Set(f, line.minor_direction);
  const auto minor_border = hn::Set(f, line.minor_border);
  const auto t_per_minor = hn::Set(f, line.t_per_minor);
  const auto last_minor_cell = hn::Set(d, line.last_minor_cell);
  const auto first_column = hn::Set(d, line.first_column);
  const auto major_offset = hn::Set(d, line.major_offset);
  const auto minor_offset = hn::Set(d, line.minor_offset);
  const auto to_second = hn::Set(d, second_offset);
  const auto end = hn::Set(d, slabs);

  /// Where the rays cross the border before slab i.
  const auto borderT = [&](IntVector i) HWY_ATTR {
    const auto distance = hn::Add(first_border, hn::Mul(hn::ConvertTo(f, i), major_step));
    const auto inside = hn::Min(hn::Max(hn::Mul(distance, t_per_major), start_t), one);
    return hn::IfThenElse(hn::RebindMask(f, hn::Eq(i, end)), one, inside);
  };
  const auto minorCell = [&](FloatVector t) HWY_ATTR {
    const auto cell = hn::ConvertTo(d, hn::Add(minor_origin, hn::Mul(minor_direction, t)));
    return hn::Min(hn::Max(cell, hn::Zero(d)), last_minor_cell);
  };
  std::size_t size = 0;
  for (int i = 0; i < slabs; i += lanes) {
    const auto slab = hn::Iota(d, i);
    const auto t_in = borderT(slab);
    const auto t_out = borderT(hn::Add(slab, hn::Set(d, 1)));
    const auto cell = minorCell(t_in);
    const auto next_cell = minorCell(t_out);
    const auto first =
        hn::Add(hn::Add(first_column, hn::Mul(slab, major_offset)), hn::Mul(cell, minor_offset));
    const auto second = hn::Add(first, to_second);
    const auto crossing = hn::Mul(hn::Add(hn::ConvertTo(f, cell), minor_border), t_per_minor);
    const auto t_second = hn::Min(hn::Max(crossing, t_in), t_out);
    const auto in_line = hn::Lt(slab, end);
    const auto has_second = hn::And(in_line, hn::Ne(cell, next_cell));

    // Both columns of each slab side by side; the second is kept when there is one.
    HWY_ALIGN std::int32_t columns[2 * hn::MaxLanes(Ints())];
    HWY_ALIGN float t[2 * hn::MaxLanes(Floats())];
    hn::StoreInterleaved2(first, second, d, columns);
    hn::StoreInterleaved2(t_in, t_second, f, t);
    if constexpr (kPacksLanes) {
      HWY_ALIGN std::int32_t keep[2 * hn::MaxLanes(Ints())];
      hn::StoreInterleaved2(hn::VecFromMask(d, in_line), hn::VecFromMask(d, has_second), d, keep);
      for (int half = 0; half < 2 * lanes; half += lanes) {
        const auto kept = hn::MaskFromVec(hn::Load(d, keep + half));
        pack(f, hn::Load(f, t + half), hn::RebindMask(f, kept), walk_t + size);
        size += pack(d, hn::Load(d, columns + half), kept, walk_column + size);
      }
    } else {
      const std::uint64_t seconds = maskBits(d, has_second);
      const int count = std::min(lanes, slabs - i);
      for (int k = 0; k < count; ++k) {
        std::memcpy(walk_column + size, columns + 2 * k, 2 * sizeof(std::int32_t));
        std::memcpy(walk_t + size, t + 2 * k, 2 * sizeof(float));
        size += 1 + ((seconds >> k) & 1u);
      }
    }
  }
  walk->t[size] = 1.0f;
  walk->size = static_cast<int>(size);
}

/// The words whose bits from[k] to below[k] - 1 are set, for some lanes k.
template <typename Int32Vector>
HWY_INLINE WordVector runMask(Int32Vector from, Int32Vector below) {
  const Words d;
  const hn::RebindToSigned<Words> d64;
  const hn::Rebind<std::int32_t, Words> d32;
  const auto ones = hn::Set(d, ~std::uint64_t{0});
  const auto filled = hn::VecFromMask(d32, hn::Lt(from, below));
  // What distances beyond a word give is taken away at the end.
  const auto shift_low = hn::BitCast(d, hn::PromoteTo(d64, from));
  const auto above = hn::Sub(hn::Set(d32, kWordBits), below);
  const auto shift_high = hn::BitCast(d, hn::PromoteTo(d64, above));
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
  // Truncation is the floor, because negative heights are cut off.
  const auto origin_low = hn::Set(f, fan.origin_z);
  const auto origin_end = hn::Set(f, fan.origin_z + 1.0f);
  const auto rise_low = hn::Set(f, fan.rise_low);
  const auto rise_high = hn::Set(f, fan.rise_high);
  const auto zero = hn::Zero(f);
  const auto top = hn::Set(d, height);
  HWY_ALIGN std::uint64_t masks[kMaxLanes];

  for (int k = 0; k < fan.columns; k += lanes) {
    const auto t_low = hn::LoadU(f, fan.t_low + k);
    const auto t_high = hn::LoadU(f, fan.t_high + k);
    const auto low = hn::ConvertTo(d, hn::Max(hn::Add(origin_low, hn::Mul(rise_low, t_low)), zero));
    const auto above =
        hn::ConvertTo(d, hn::Max(hn::Add(origin_end, hn::Mul(rise_high, t_high)), zero));
    const auto end = hn::Min(above, top);
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

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
