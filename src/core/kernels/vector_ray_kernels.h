// From the ends of rays to what they pass, in vectors.
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

void roundRays(const DirectionCube& cube, const RayEnds& ends, const std::int32_t* index, int count,
               float cut, CubeRays* rays) {
  const Floats f;
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  rays->reserve(count);
  const auto half = hn::Set(f, 0.5f);
  const auto half_side = hn::Set(f, static_cast<float>(cube.half_side));
  const auto reach = hn::Sub(half_side, hn::Set(f, DirectionCube::kSlack));
  const auto to_cell = hn::Add(half_side, half);
  const auto last_cell = hn::Set(d, cube.side() - 1);
  const auto toCenter = [&](IntVector cell, float origin) HWY_ATTR {
    return hn::Sub(hn::Add(hn::ConvertTo(f, cell), half), hn::Set(f, origin));
  };
  for (int i = 0; i < count; i += lanes) {
    // What lies beyond the last one are indices of an earlier scan, or zeros.
    const auto in_list = hn::FirstN(d, std::min(lanes, count - i));
    const auto k = hn::IfThenElseZero(in_list, hn::LoadU(d, index + i));
    const auto height =
        hn::And(hn::GatherIndex(d, ends.z.data(), k), hn::Set(d, RayEnds::kLeavesBox - 1));
    const auto x = toCenter(hn::GatherIndex(d, ends.x.data(), k), cube.origin[0]);
    const auto y = toCenter(hn::GatherIndex(d, ends.y.data(), k), cube.origin[1]);
    const auto rise = toCenter(height, cube.origin[2]);
    const auto is_x = hn::Ge(hn::Abs(x), hn::Abs(y));
    const auto major = hn::IfThenElse(is_x, x, y);
    const auto minor = hn::IfThenElse(is_x, y, x);
    const auto distance = hn::Abs(major);
    const auto is_rounded = hn::And(hn::And(hn::Gt(distance, hn::Zero(f)), hn::Le(distance, reach)),
                                    hn::Le(hn::Abs(rise), distance));
    const auto to_face = hn::Div(half_side, distance);
    const auto length =
        hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(rise, rise)));
    const auto left = hn::Sub(hn::Set(f, 1.0f), hn::Div(hn::Set(f, cut), length));
    const auto cellAt = [&](FloatVector at) HWY_ATTR {
      const auto cell = hn::ConvertTo(d, hn::Add(hn::Mul(at, to_face), to_cell));
      return hn::Min(hn::Max(cell, hn::Zero(d)), last_cell);
    };
    const auto is_second = hn::RebindMask(d, hn::Lt(major, hn::Zero(f)));
    const auto face = hn::Add(hn::IfThenElse(hn::RebindMask(d, is_x), hn::Zero(d), hn::Set(d, 2)),
                              hn::IfThenElseZero(is_second, hn::Set(d, 1)));
    const auto slice = hn::Add(hn::Mul(face, hn::Set(d, cube.side())), cellAt(minor));
    const auto rounded = hn::RebindMask(d, is_rounded);
    hn::StoreU(hn::IfThenElse(rounded, slice, hn::Set(d, CubeRays::kStraight)), d,
               rays->slice.data() + i);
    hn::StoreU(hn::IfThenElseZero(rounded, cellAt(rise)), d, rays->cell.data() + i);
    hn::StoreU(hn::Mul(distance, left), f, rays->reach.data() + i);
  }
}

void walk(const ColumnLine& line, ColumnWalk* walk) {
  const Floats f;
  const Ints d;
  const hn::RebindToUnsigned<Ints> u;
  const int lanes = static_cast<int>(hn::Lanes(d));
  walk->reserve(line.slabs);
  std::int32_t* const walk_column = walk->column.data();
  float* const walk_t = walk->t.data();
  std::int32_t* const first_of_slab = walk->first_of_slab.data();
  const std::int32_t second_offset = line.minor_step * line.minor_offset;
  const int slabs = line.slabs;

  // Out of the loop by hand: for all that the compiler knows, what it writes could be `line`.
  const auto end_t = hn::Set(f, line.end_t);
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
    const auto inside = hn::Min(hn::Max(hn::Mul(distance, t_per_major), start_t), end_t);
    return hn::IfThenElse(hn::RebindMask(f, hn::Eq(i, end)), end_t, inside);
  };
  const auto minorCell = [&](FloatVector t) HWY_ATTR {
    const auto cell = hn::ConvertTo(d, hn::Add(minor_origin, hn::Mul(minor_direction, t)));
    return hn::Min(hn::Max(cell, hn::Zero(d)), last_minor_cell);
  };
  // Of lane i, a bit for each of the lanes before it.
  const auto before = hn::Sub(hn::Shl(hn::Set(u, 1), hn::Iota(u, 0)), hn::Set(u, 1));
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
    const std::uint64_t seconds = maskBits(d, has_second);
    if constexpr (kPacksLanes) {
      const auto earlier = hn::And(hn::Set(u, static_cast<std::uint32_t>(seconds)), before);
      const auto index =
          hn::Add(hn::Iota(u, static_cast<std::uint32_t>(size)), hn::PopulationCount(earlier));
      hn::StoreU(hn::BitCast(d, index), d, first_of_slab + i);
      HWY_ALIGN std::int32_t keep[2 * hn::MaxLanes(Ints())];
      hn::StoreInterleaved2(hn::VecFromMask(d, in_line), hn::VecFromMask(d, has_second), d, keep);
      for (int half = 0; half < 2 * lanes; half += lanes) {
        const auto kept = hn::MaskFromVec(hn::Load(d, keep + half));
        pack(f, hn::Load(f, t + half), hn::RebindMask(f, kept), walk_t + size);
        size += pack(d, hn::Load(d, columns + half), kept, walk_column + size);
      }
    } else {
      const int count = std::min(lanes, slabs - i);
      for (int k = 0; k < count; ++k) {
        std::memcpy(walk_column + size, columns + 2 * k, 2 * sizeof(std::int32_t));
        std::memcpy(walk_t + size, t + 2 * k, 2 * sizeof(float));
        first_of_slab[i + k] = static_cast<std::int32_t>(size);
        size += 1 + ((seconds >> k) & 1u);
      }
    }
  }
  walk->t[size] = line.end_t;
  first_of_slab[slabs] = static_cast<std::int32_t>(size);
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

void freeRuns(const RayRuns& part, int height, std::uint64_t* free) {
  const Floats f;
  const Ints d;
  const hn::Half<Ints> half;
  const Words d64;
  constexpr int kMaxLanes = hn::MaxLanes(Ints());
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int words = (height + kWordBits - 1) / kWordBits;
  const auto origin_z = hn::Set(f, part.origin_z);
  const auto below_all = hn::Set(f, -1.0f);
  const auto one = hn::Set(f, 1.0f);
  const auto zero = hn::Zero(f);
  const auto top = hn::Set(d, height);
  HWY_ALIGN std::uint64_t masks[kMaxLanes];

  for (int k = 0; k < part.columns; k += lanes) {
    const auto t_in = hn::LoadU(f, part.t + k);
    const auto t_out = hn::LoadU(f, part.t + k + 1);
    const int count = std::min(lanes, part.columns - k);
    const std::int32_t* const column = part.column + k;
    for (int w = 0; w < words; ++w) {
      const auto base = hn::Set(d, w * kWordBits);
      auto lower = hn::Zero(d64);  // masks of the first half of the columns
      auto upper = hn::Zero(d64);
      for (int r = 0; r < part.runs; ++r) {
        const auto rise_low = hn::Set(f, part.rise_low[r]);
        const auto rise_high = hn::Set(f, part.rise_high[r]);
        const auto low = hn::Min(hn::Mul(rise_low, t_in), hn::Mul(rise_low, t_out));
        const auto high = hn::Max(hn::Mul(rise_high, t_in), hn::Mul(rise_high, t_out));
        // Truncation is the floor, because negative heights are cut off.
        const auto from_z = hn::ConvertTo(d, hn::Max(hn::Add(origin_z, low), zero));
        const auto above =
            hn::ConvertTo(d, hn::Add(hn::Max(hn::Add(origin_z, high), below_all), one));
        const auto end_z = hn::Min(above, top);
        const auto from = hn::Max(hn::Sub(from_z, base), hn::Zero(d));
        const auto below = hn::Min(hn::Sub(end_z, base), hn::Set(d, kWordBits));
        if (words > 1 && hn::AllFalse(d, hn::Lt(from, below))) continue;
        lower = hn::Or(lower, runMask(hn::LowerHalf(half, from), hn::LowerHalf(half, below)));
        upper = hn::Or(upper, runMask(hn::UpperHalf(half, from), hn::UpperHalf(half, below)));
      }
      hn::Store(lower, d64, masks);
      hn::Store(upper, d64, masks + lanes / 2);
      std::uint64_t* const word = free + w;
      for (int j = 0; j < count; ++j) word[column[j]] |= masks[j];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
