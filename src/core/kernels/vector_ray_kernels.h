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

/// Where the rays to some points end; those that leave the box are flagged in z.
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

/// EndPoints in vectors. Made once before the loop: for all that the compiler knows, what the loop
/// writes could be the numbers that it begins with.
struct EndBox {
  FloatVector to_voxels, origin_x, origin_y, origin_z, size_x, size_y, size_z;
};

HWY_INLINE EndBox endBox(const EndPoints& points) {
  const Floats f;
  const auto sizeOf = [&](int axis)
                          HWY_ATTR { return hn::Set(f, static_cast<float>(points.size[axis])); };
  return {hn::Set(f, points.to_voxels),
          hn::Set(f, points.origin[0]),
          hn::Set(f, points.origin[1]),
          hn::Set(f, points.origin[2]),
          sizeOf(0),
          sizeOf(1),
          sizeOf(2)};
}

/// Where the rays end that leave the box.
HWY_INLINE EndVoxels leavingEnds(const EndBox& box, FloatVector x, FloatVector y, FloatVector z,
                                 EndVoxels ends) {
  const Floats f;
  const Ints d;
  const auto ray_x = hn::Sub(x, box.origin_x);
  const auto ray_y = hn::Sub(y, box.origin_y);
  const auto ray_z = hn::Sub(z, box.origin_z);
  const auto exit = hn::Min(hn::Min(hn::Set(f, 1.0f), exitOfSlab(box.origin_x, ray_x, box.size_x)),
                            hn::Min(exitOfSlab(box.origin_y, ray_y, box.size_y),
                                    exitOfSlab(box.origin_z, ray_z, box.size_z)));
  const auto last = [&](FloatVector origin, FloatVector ray, FloatVector size) HWY_ATTR {
    const auto cell = hn::ConvertTo(d, hn::Add(origin, hn::Mul(exit, ray)));
    const auto last_cell = hn::Sub(hn::ConvertTo(d, size), hn::Set(d, 1));
    return hn::Min(hn::Max(cell, hn::Zero(d)), last_cell);
  };
  const auto leaving = hn::RebindMask(d, ends.leaving);
  ends.x = hn::IfThenElse(leaving, last(box.origin_x, ray_x, box.size_x), ends.x);
  ends.y = hn::IfThenElse(leaving, last(box.origin_y, ray_y, box.size_y), ends.y);
  const auto z_in_box = last(box.origin_z, ray_z, box.size_z);
  const auto flagged = hn::Or(z_in_box, hn::Set(d, RayEnds::kLeavesBox));
  ends.z = hn::IfThenElse(leaving, flagged, ends.z);
  return ends;
}

/// Of the points from i on.
HWY_INLINE EndVoxels endVoxels(const EndPoints& points, const EndBox& box, int i) {
  const Floats f;
  const Ints d;
  const auto is_inside = [&](FloatVector p, FloatVector size)
                             HWY_ATTR { return hn::And(hn::Ge(p, hn::Zero(f)), hn::Lt(p, size)); };
  const auto x = hn::Add(box.origin_x, hn::Mul(hn::LoadU(f, points.x + i), box.to_voxels));
  const auto y = hn::Add(box.origin_y, hn::Mul(hn::LoadU(f, points.y + i), box.to_voxels));
  const auto z = hn::Add(box.origin_z, hn::Mul(hn::LoadU(f, points.z + i), box.to_voxels));
  const auto inside = hn::And(hn::And(is_inside(x, box.size_x), is_inside(y, box.size_y)),
                              is_inside(z, box.size_z));
  const EndVoxels ends{hn::ConvertTo(d, x), hn::ConvertTo(d, y), hn::ConvertTo(d, z),
                       hn::Not(inside)};
  return hn::AllTrue(f, inside) ? ends : leavingEnds(box, x, y, z, ends);
}

/// Smallest and largest x and y of what was listed.
struct EndBounds {
  IntVector low_x, low_y, high_x, high_y;
};

/// Appends the ends of the rays in `listed`, of those from `first` on.
HWY_INLINE void appendEnds(IntVector x, IntVector y, IntVector z, int first, hn::Mask<Ints> listed,
                           EndBounds* bounds, RayEnds* ends) {
  const Ints d;
  bounds->low_x = hn::Min(bounds->low_x, hn::IfThenElse(listed, x, bounds->low_x));
  bounds->low_y = hn::Min(bounds->low_y, hn::IfThenElse(listed, y, bounds->low_y));
  bounds->high_x = hn::Max(bounds->high_x, hn::IfThenElse(listed, x, bounds->high_x));
  bounds->high_y = hn::Max(bounds->high_y, hn::IfThenElse(listed, y, bounds->high_y));
  std::int32_t* const to_x = ends->x.data() + ends->size;
  std::int32_t* const to_y = ends->y.data() + ends->size;
  std::int32_t* const to_z = ends->z.data() + ends->size;
  std::int32_t* const to_first = ends->first.data() + ends->size;
  if constexpr (kPacksLanes) {
    pack(d, x, listed, to_x);
    pack(d, y, listed, to_y);
    pack(d, hn::Iota(d, first), listed, to_first);
    ends->size += pack(d, z, listed, to_z);
    return;
  }
  // Most vectors list one or two.
  HWY_ALIGN std::int32_t all[3][hn::MaxLanes(Ints())];
  hn::Store(x, d, all[0]);
  hn::Store(y, d, all[1]);
  hn::Store(z, d, all[2]);
  int count = 0;
  for (std::uint64_t rest = maskBits(d, listed); rest != 0; rest &= rest - 1) {
    const int i = __builtin_ctzll(rest);
    to_x[count] = all[0][i];
    to_y[count] = all[1][i];
    to_z[count] = all[2][i];
    to_first[count] = first + i;
    ++count;
  }
  ends->size += count;
}

void listEnds(const EndPoints& points, RayEnds* ends) {
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int count = points.count;
  ends->begin(count);
  const EndBox box = endBox(points);
  EndBounds bounds{hn::Set(d, ends->low[0]), hn::Set(d, ends->low[1]), hn::Set(d, ends->high[0]),
                   hn::Set(d, ends->high[1])};
  // Lane i of the result is lane i - 1, lane 0 the last one.
  const auto before_each =
      hn::IndicesFromVec(d, hn::And(hn::Iota(d, lanes - 1), hn::Set(d, lanes - 1)));
  const auto lane_0 = hn::FirstN(d, 1);
  auto last_x = hn::Set(d, -1);  // no end's, so that the first one is listed
  auto last_y = last_x;
  auto last_z = last_x;
  for (int i = 0; i < count; i += lanes) {
    const EndVoxels now = endVoxels(points, box, i);
    const auto rotated_x = hn::TableLookupLanes(now.x, before_each);
    const auto rotated_y = hn::TableLookupLanes(now.y, before_each);
    const auto rotated_z = hn::TableLookupLanes(now.z, before_each);
    const auto other_x = hn::Xor(now.x, hn::IfThenElse(lane_0, last_x, rotated_x));
    const auto other_y = hn::Xor(now.y, hn::IfThenElse(lane_0, last_y, rotated_y));
    const auto other_z = hn::Xor(now.z, hn::IfThenElse(lane_0, last_z, rotated_z));
    last_x = rotated_x;
    last_y = rotated_y;
    last_z = rotated_z;
    auto listed = hn::Ne(hn::Or(hn::Or(other_x, other_y), other_z), hn::Zero(d));
    if (i + lanes > count) listed = hn::And(listed, hn::FirstN(d, count - i));
    if (!hn::AllFalse(d, listed)) appendEnds(now.x, now.y, now.z, i, listed, &bounds, ends);
  }
  ends->first[ends->size] = count;
  ends->low[0] = hn::GetLane(hn::MinOfLanes(d, bounds.low_x));
  ends->low[1] = hn::GetLane(hn::MinOfLanes(d, bounds.low_y));
  ends->high[0] = hn::GetLane(hn::MaxOfLanes(d, bounds.high_x));
  ends->high[1] = hn::GetLane(hn::MaxOfLanes(d, bounds.high_y));
}

/// The words with these indices.
HWY_INLINE WordVector gatherWords(const std::uint64_t* words, hn::Vec<hn::Half<Ints>> index) {
  const Words d;
  const hn::RebindToSigned<Words> d64;
  return hn::GatherIndex(d, words, hn::PromoteTo(d64, index));
}

int selectEnds(const RayEnds& ends, int first, int last, const VoxelBits& bits, bool value,
               std::int32_t* listed) {
  // Where the machine does not gather by itself, plain C++ is as fast.
  if constexpr (!kGathers) return plainKernels().selectEnds(ends, first, last, bits, value, listed);
  const Ints d;
  const Words d64;
  const hn::Half<Ints> half;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d64, 1);
  const auto size_y = hn::Set(d, bits.size_y);
  const auto words_per_column = hn::Set(d, bits.words_per_column);
  const auto unwanted = hn::Set(d, value ? 0 : 1);
  const auto bitsAt = [&](hn::Vec<decltype(half)> word, hn::Vec<decltype(half)> bit) HWY_ATTR {
    const hn::RebindToSigned<Words> signed64;
    const auto shift = hn::BitCast(d64, hn::PromoteTo(signed64, bit));
    const auto found = hn::And(gatherWords(bits.words, word) >> shift, one);
    return hn::BitCast(half, hn::TruncateTo(hn::RebindToUnsigned<hn::Half<Ints>>(), found));
  };
  int count = 0;
  for (int k = first; k < last; k += lanes) {
    // What lies beyond the last one may be no voxel.
    const auto in_list = hn::FirstN(d, std::min(lanes, last - k));
    const auto x = hn::IfThenElseZero(in_list, hn::LoadU(d, ends.x.data() + k));
    const auto y = hn::IfThenElseZero(in_list, hn::LoadU(d, ends.y.data() + k));
    const auto flagged = hn::IfThenElseZero(in_list, hn::LoadU(d, ends.z.data() + k));
    const auto z = hn::And(flagged, hn::Set(d, RayEnds::kLeavesBox - 1));
    const auto column = hn::Mul(hn::Add(hn::Mul(x, size_y), y), words_per_column);
    const auto word = hn::Add(column, hn::ShiftRight<kWordShift>(z));
    const auto bit = hn::And(z, hn::Set(d, kWordBits - 1));
    const auto found = hn::Combine(d, bitsAt(hn::UpperHalf(half, word), hn::UpperHalf(half, bit)),
                                   bitsAt(hn::LowerHalf(half, word), hn::LowerHalf(half, bit)));
    const auto in_box = hn::Lt(flagged, hn::Set(d, RayEnds::kLeavesBox));
    const auto selected = hn::Ne(hn::IfThenElseZero(in_box, found), unwanted);
    count += pack(d, hn::Iota(d, k), hn::And(in_list, selected), listed + count);
  }
  return count;
}

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
