#include "fiimap/ray_caster.h"

#include <algorithm>
#include <cmath>

namespace fiimap {
namespace {

/// Part [enter, exit] of the ray origin + t * direction, t in [0, 1], that lies in [0, size].
struct Span {
  float enter = 0.0f;
  float exit = 1.0f;
  bool empty() const { return enter > exit; }
};

void clipToSlab(float origin, float direction, float size, Span* span) {
  if (direction == 0.0f) {
    if (origin < 0.0f || origin > size) *span = {1.0f, 0.0f};
    return;
  }
  const float t_low = -origin / direction;
  const float t_high = (size - origin) / direction;
  span->enter = std::max(span->enter, std::min(t_low, t_high));
  span->exit = std::min(span->exit, std::max(t_low, t_high));
}

/// Voxel of the box that holds a point on the box's surface, or just off it by rounding.
VoxelIndex nearestVoxel(const Eigen::Vector3f& p, const VoxelIndex& size) {
  const VoxelIndex v = p.array().floor().cast<int>();
  return v.cwiseMax(0).cwiseMin(size - VoxelIndex::Ones());
}

/// Part of a ray that lies in the box [0, size].
Span clipToBox(const Eigen::Vector3f& origin, const Eigen::Vector3f& ray, const VoxelIndex& size) {
  Span span;
  for (int axis = 0; axis < 3; ++axis) {
    clipToSlab(origin[axis], ray[axis], static_cast<float>(size[axis]), &span);
  }
  return span;
}

int ceilToInt(float value) { return -floorToInt(-value); }

}  // namespace

RayCaster::RayCaster(const VoxelLattice& lattice, double end_cut, double min_hit_cover)
    : lattice_(lattice),
      end_cut_(static_cast<float>(end_cut)),
      hit_cover_(min_hit_cover),
      kernels_(kernels()) {}

RayCount RayCaster::cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask) {
  mask->begin(box);
  RayCount count;
  if (box.empty()) return count;
  const VoxelIndex& size = mask->size();

  // Relative to the box, so that coordinates are small wherever the vehicle is.
  origin_ = (scan.origin / lattice_.resolution() - box.min.cast<double>()).cast<float>();
  markEnds(scan.misses, false, mask, &count);
  markEnds(scan.returns, true, mask, &count);  // last: ends_ is read again below
  for (const std::int32_t offset : mask->endColumns()) {
    const int column = offset / mask->wordsPerColumn();
    const int x = column / size.y();
    const int y = column % size.y();
    walkTo(x, y, mask);
    carve(x, y, mask);
  }
  count.hits -= hit_cover_.dropSlivers(scan, ends_, origin_, lattice_.resolution(), mask);
  return count;
}

void RayCaster::markEnds(const PointList& ends, bool are_returns, ScanMask* mask, RayCount* count) {
  listEnds(ends, *mask);
  for (int k = 0; k < ends_.size; ++k) {
    if (ends_.z[k] == RayEnds::kMissesBox) continue;
    const bool leaves = ends_.z[k] >= RayEnds::kLeavesBox;
    const bool is_return = are_returns && !leaves;
    const ScanMask::Layer layer = is_return ? ScanMask::kHit : ScanMask::kMissEnd;
    const bool is_new = mask->markEnd(layer, ends_.column[k], ends_.z[k] % RayEnds::kLeavesBox);
    if (is_new) ++(is_return ? count->hits : count->misses);
  }
}

void RayCaster::listEnds(const PointList& ends, const ScanMask& mask) {
  const float to_voxels = static_cast<float>(1.0 / lattice_.resolution());
  const int count = static_cast<int>(ends.size());
  const Eigen::Array3f size = mask.size().cast<float>();
  if ((origin_.array() < 0.0f).any() || (origin_.array() > size).any()) {
    // Rays that enter the box on their way are too rare for a kernel.
    ends_.reserve(count);
    ends_.size = 0;
    for (const Eigen::Vector3f& end : ends) listEnd(end * to_voxels, mask);
    ends_.first[ends_.size] = ends_.size;
    return;
  }
  EndPoints points;
  points.x = ends.x();
  points.y = ends.y();
  points.z = ends.z();
  points.count = count;
  points.to_voxels = to_voxels;
  points.words = mask.wordsPerColumn();
  for (int axis = 0; axis < 3; ++axis) {
    points.origin[axis] = origin_[axis];
    points.size[axis] = mask.size()[axis];
  }
  kernels_.listEnds(points, &ends_);
}

/// Of a sensor anywhere.
void RayCaster::listEnd(const Eigen::Vector3f& ray, const ScanMask& mask) {
  const VoxelIndex& size = mask.size();
  const Eigen::Vector3f end = origin_ + ray;
  VoxelIndex v = end.cast<int>();  // the floor, inside the box
  std::int32_t flag = 0;
  if (!((end.array() >= 0.0f).all() && (end.array() < size.cast<float>().array()).all())) {
    const Span span = clipToBox(origin_, ray, size);
    flag = span.empty() ? RayEnds::kMissesBox : RayEnds::kLeavesBox;
    v = span.empty() ? VoxelIndex::Zero() : nearestVoxel(origin_ + span.exit * ray, size);
  }
  ends_.column[ends_.size] = mask.columnOffset(v.x(), v.y());
  ends_.z[ends_.size] = v.z() + flag;
  ends_.first[ends_.size] = ends_.size;
  ++ends_.size;
}

/// The line of the rays to an end column over the columns of the mask.
void RayCaster::walkTo(int end_x, int end_y, ScanMask* mask) {
  const int end[2] = {end_x, end_y};
  const float direction[2] = {end_x + 0.5f - origin_.x(), end_y + 0.5f - origin_.y()};
  const int offset[2] = {mask->columnOffset(1, 0), mask->columnOffset(0, 1)};
  const int major = std::abs(direction[0]) >= std::abs(direction[1]) ? 0 : 1;
  const int minor = 1 - major;
  Span span;
  for (int axis = 0; axis < 2; ++axis) {
    clipToSlab(origin_[axis], direction[axis], static_cast<float>(mask->size()[axis]), &span);
  }

  ColumnLine line;
  line.start_t = std::min(span.enter, 1.0f);
  const int start = std::clamp(floorToInt(origin_[major] + direction[major] * line.start_t), 0,
                               mask->size()[major] - 1);
  const int step = end[major] >= start ? 1 : -1;
  line.slabs = std::abs(end[major] - start) + 1;
  line.first_border = static_cast<float>(start + (step > 0 ? 0 : 1)) - origin_[major];
  line.major_step = static_cast<float>(step);
  line.t_per_major = line.slabs > 1 ? 1.0f / direction[major] : 0.0f;
  line.minor_origin = origin_[minor];
  line.minor_direction = direction[minor];
  line.minor_step = direction[minor] > 0.0f ? 1 : -1;
  line.minor_border = (line.minor_step > 0 ? 1.0f : 0.0f) - origin_[minor];
  line.t_per_minor = direction[minor] != 0.0f ? 1.0f / direction[minor] : 0.0f;
  line.last_minor_cell = mask->size()[minor] - 1;
  line.first_column = start * offset[major];
  line.major_offset = step * offset[major];
  line.minor_offset = offset[minor];
  kernels_.walk(line, &walk_);

  mask->touch(end_x, end_y);
  const int first = walk_.column[0] / mask->wordsPerColumn();
  mask->touch(first / mask->size().y(), first % mask->size().y());
}

void RayCaster::carve(int end_x, int end_y, ScanMask* mask) {
  const float distance_2 =
      (Eigen::Vector2f(end_x + 0.5f, end_y + 0.5f) - origin_.head<2>()).squaredNorm();
  for (const ScanMask::Layer layer : {ScanMask::kHit, ScanMask::kMissEnd}) {
    const float cut = layer == ScanMask::kHit ? end_cut_ : 0.0f;
    forEachRun(mask->column(layer, end_x, end_y), mask->wordsPerColumn(),
               [&](int z_low, int z_high) {
                 carveFan({z_low, z_high, cut, distance_2}, mask);
               });
  }
}

void RayCaster::carveFan(const Fan& fan, ScanMask* mask) {
  if (fan.z_low == fan.z_high) return carveRay(fan, mask);
  // The shortest ray of the fan is cut off first; up to there all rays pass together.
  const int z_nearest = std::clamp(floorToInt(origin_.z()), fan.z_low, fan.z_high);
  const float t_together = endOfRay(fan, z_nearest);
  int together = walk_.size;
  while (together > 0 && walk_.t[together] > t_together) --together;
  carveTogether(fan, together, mask);
  if (together < walk_.size) carveApart(fan, together, mask);
}

/// A fan of one ray, which leaves its last column where it ends.
void RayCaster::carveRay(const Fan& ray, ScanMask* mask) {
  const float t_end = endOfRay(ray, ray.z_low);
  int columns = walk_.size;
  while (columns > 0 && walk_.t[columns - 1] > t_end) --columns;
  const float t_out = walk_.t[columns];
  walk_.t[columns] = std::min(t_out, t_end);
  carveTogether(ray, columns, mask);
  walk_.t[columns] = t_out;
}

/// In each column all rays of the fan touch one run of voxels, from where the lowest ray is lowest
/// to where the highest ray is highest.
void RayCaster::carveTogether(const Fan& fan, int columns, ScanMask* mask) const {
  FanPart part;
  part.column = walk_.column.data();
  part.columns = columns;
  part.origin_z = origin_.z();
  part.rise_low = fan.z_low + 0.5f - origin_.z();
  part.rise_high = fan.z_high + 0.5f - origin_.z();
  part.t_low = walk_.t.data() + (part.rise_low < 0.0f ? 1 : 0);
  part.t_high = walk_.t.data() + (part.rise_high < 0.0f ? 0 : 1);
  part.lowest = origin_.z() + std::min(0.0f, part.rise_low);
  part.highest = origin_.z() + std::max(0.0f, part.rise_high);
  kernels_.freeFan(part, mask->size().z(), mask->column(ScanMask::kFree, 0, 0));
}

/// Where some rays have ended already: those left are the longest, at the fan's upper and lower
/// end. Neighbouring rays are at most a voxel apart, so that each of the two groups touches one
/// run.
void RayCaster::carveApart(const Fan& fan, int first, ScanMask* mask) const {
  const float rise_low = fan.z_low + 0.5f - origin_.z();
  const float rise_high = fan.z_high + 0.5f - origin_.z();
  const float t_end_low = endOfRay(fan, fan.z_low);
  const float t_end_high = endOfRay(fan, fan.z_high);
  for (int k = first; k < walk_.size; ++k) {
    const float t_in = walk_.t[k];
    const float t_out = walk_.t[k + 1];
    // A ray reaches t_in when its length is at least cut / (1 - t_in).
    const float length = t_in < 1.0f ? fan.cut / (1.0f - t_in) : 0.0f;
    const float rise_2 = length * length - fan.distance_2;
    const float rise = rise_2 > 0.0f ? std::sqrt(rise_2) : 0.0f;
    if (rise_high >= rise && t_in <= t_end_high) {
      const int z = std::max(fan.z_low, ceilToInt(origin_.z() + rise - 0.5f));
      const float lowest = origin_.z() + (z + 0.5f - origin_.z()) * t_in;
      const float highest = origin_.z() + rise_high * std::min(t_out, t_end_high);
      mask->markFreeRun(walk_.column[k], floorToInt(lowest), floorToInt(highest));
    }
    if (rise_low <= -rise && t_in <= t_end_low) {
      const int z = std::min(fan.z_high, floorToInt(origin_.z() - rise - 0.5f));
      const float lowest = origin_.z() + rise_low * std::min(t_out, t_end_low);
      const float highest = origin_.z() + (z + 0.5f - origin_.z()) * t_in;
      mask->markFreeRun(walk_.column[k], floorToInt(lowest), floorToInt(highest));
    }
  }
}

/// Where the ray to voxel z of the end column ends, before its cut.
float RayCaster::endOfRay(const Fan& fan, int z) const {
  const float rise = z + 0.5f - origin_.z();
  const float length = std::sqrt(fan.distance_2 + rise * rise);
  return length > 0.0f ? 1.0f - fan.cut / length : (fan.cut > 0.0f ? -1.0f : 1.0f);
}

}  // namespace fiimap
