#include "fiimap/ray_slices.h"

#include <algorithm>
#include <cmath>

#include "fiimap/bit_column.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

void RaySlices::begin(const DirectionCube& cube) {
  constexpr int kFaces = 4;
  cube_ = cube;
  per_cell_ = 1.0f / static_cast<float>(cube.half_side);
  slot_of_.resize(std::max<std::size_t>(slot_of_.size(), kFaces * cube.side()), kNone);
}

void RaySlices::add(std::int32_t slice, std::int32_t cell, float reach) {
  std::int32_t& slot = slot_of_[slice];
  if (slot == kNone) {
    slot = static_cast<std::int32_t>(slices_.size());
    slices_.push_back({slice, cell, cell, 0.0f});
    reach_.resize(std::max(reach_.size(), slices_.size() * cube_.side()), 0.0f);
  }
  Slice& beams = slices_[slot];
  beams.first_cell = std::min(beams.first_cell, cell);
  beams.last_cell = std::max(beams.last_cell, cell);
  beams.reach = std::max(beams.reach, reach);
  float& longest = reach_[static_cast<std::size_t>(slot) * cube_.side() + cell];
  longest = std::max(longest, reach);
}

void RaySlices::carve(ScanMask* mask) {
  float* row = reach_.data();
  for (const Slice& slice : slices_) {
    const int beams = slice.last_cell - slice.first_cell + 1;
    beam_reach_ = row + slice.first_cell;
    walkAlong(slice, *mask);
    findEnds(beams);
    sweep(slice.first_cell, mask);
    std::fill_n(row + slice.first_cell, beams, 0.0f);
    slot_of_[slice.index] = kNone;
    row += cube_.side();
  }
  slices_.clear();
}

/// The columns that the slice crosses, up to the reach of its longest beam.
void RaySlices::walkAlong(const Slice& slice, const ScanMask& mask) {
  const int face = slice.index / cube_.side();
  const int major = face / 2;
  const int minor = 1 - major;
  const float sign = face % 2 == 0 ? 1.0f : -1.0f;
  const float slope = slopeOf(slice.index % cube_.side());
  const int offset[2] = {mask.columnOffset(1, 0), mask.columnOffset(0, 1)};
  const float origin = cube_.origin[major];
  const int last = mask.size()[major] - 1;
  const int start = std::clamp(floorToInt(origin), 0, last);
  const int end = std::clamp(floorToInt(origin + sign * slice.reach), 0, last);
  slabs_ = std::abs(end - start) + 1;
  first_border_ = sign > 0.0f ? start - origin : origin - (start + 1);

  ColumnLine line;
  line.slabs = slabs_;
  line.start_t = 0.0f;
  line.end_t = slice.reach;
  line.first_border = first_border_;
  line.major_step = 1.0f;
  line.t_per_major = 1.0f;
  line.minor_origin = cube_.origin[minor];
  line.minor_direction = slope;
  line.minor_step = slope > 0.0f ? 1 : -1;
  line.minor_border = (line.minor_step > 0 ? 1.0f : 0.0f) - cube_.origin[minor];
  line.t_per_minor = slope != 0.0f ? 1.0f / slope : 0.0f;
  line.last_minor_cell = mask.size()[minor] - 1;
  line.first_column = start * offset[major];
  line.major_offset = (sign > 0.0f ? 1 : -1) * offset[major];
  line.minor_offset = offset[minor];
  kernels_.walk(line, &walk_);
}

/// Index of the column of the walk that lies at a distance.
int RaySlices::columnAt(float distance) const {
  const int slab = std::clamp(static_cast<int>(distance - first_border_), 0, slabs_ - 1);
  const int k = walk_.first_of_slab[slab];
  const bool has_second = walk_.first_of_slab[slab + 1] - k > 1;
  return has_second && distance > walk_.t[k + 1] ? k + 1 : k;
}

void RaySlices::findEnds(int beams) {
  last_.resize(beams);
  int before = kNone;
  for (int i = 0; i < beams; ++i) {
    last_[i] = beam_reach_[i] > 0.0f ? columnAt(beam_reach_[i]) : kNone;
    if (last_[i] == kNone) continue;
    if (before != kNone && i - before > 1) closeGap(before, i);
    before = i;
  }
}

/// Between two beams that are less than a voxel edge apart up to some distance, others change
/// nothing up to there, and make one run of what would be two.
void RaySlices::closeGap(int before, int after) {
  const float together = static_cast<float>(cube_.half_side) / static_cast<float>(after - before);
  const int slab = std::clamp(static_cast<int>(together - first_border_), 0, slabs_ - 1);
  const int end = std::min({walk_.first_of_slab[slab], last_[before], last_[after]});
  if (end > 0) std::fill(last_.begin() + before + 1, last_.begin() + after, end);
}

/// From the origin outwards: columns that are crossed by the same beams are freed together.
void RaySlices::sweep(int first_cell, ScanMask* mask) {
  const int beams = static_cast<int>(last_.size());
  ending_.assign(walk_.size, kNone);
  next_.resize(beams);
  alive_.assign((beams + kWordBits - 1) / kWordBits, 0);
  for (int i = 0; i < beams; ++i) {
    if (last_[i] == kNone) continue;
    next_[i] = ending_[last_[i]];
    ending_[last_[i]] = i;
    alive_[i / kWordBits] |= std::uint64_t{1} << (i % kWordBits);
  }
  for (int k = 0; k < walk_.size;) {
    endBeams(k, first_cell, mask);
    int end = k + 1;
    while (end < walk_.size && ending_[end] == kNone) ++end;
    listRuns(first_cell);
    if (rise_low_.empty()) return;
    RayRuns part;
    part.column = walk_.column.data() + k;
    part.t = walk_.t.data() + k;
    part.columns = end - k;
    part.origin_z = cube_.origin[2];
    part.rise_low = rise_low_.data();
    part.rise_high = rise_high_.data();
    part.runs = static_cast<int>(rise_low_.size());
    kernels_.freeRuns(part, mask->size().z(), mask->column(ScanMask::kFree, 0, 0));
    k = end;
  }
}

/// Beams that end in column k touch a part of it.
void RaySlices::endBeams(int k, int first_cell, ScanMask* mask) {
  for (int i = ending_[k]; i != kNone; i = next_[i]) {
    alive_[i / kWordBits] &= ~(std::uint64_t{1} << (i % kWordBits));
    if (!(beam_reach_[i] > 0.0f)) continue;  // closes a gap
    const float slope = slopeOf(first_cell + i);
    const float in = cube_.origin[2] + slope * walk_.t[k];
    const float out = cube_.origin[2] + slope * std::min(beam_reach_[i], walk_.t[k + 1]);
    mask->markFreeRun(walk_.column[k], floorToInt(std::min(in, out)),
                      floorToInt(std::max(in, out)));
  }
}

void RaySlices::listRuns(int first_cell) {
  rise_low_.clear();
  rise_high_.clear();
  forEachRun(alive_.data(), static_cast<int>(alive_.size()), [&](int first, int last) {
    rise_low_.push_back(slopeOf(first_cell + first));
    rise_high_.push_back(slopeOf(first_cell + last));
  });
}

}  // namespace fiimap
