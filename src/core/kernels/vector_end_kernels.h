// From points to the voxels in which rays end, in vectors.
// Included once for each instruction set, which is why its guard comes and goes.
#if defined(FIIMAP_VECTOR_END_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIIMAP_VECTOR_END_KERNELS_H
#undef FIIMAP_VECTOR_END_KERNELS_H
#else
#define FIIMAP_VECTOR_END_KERNELS_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

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

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();

#endif  // guard of the instruction set
