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
  // Clamped first: the point may be too far away for an integer.
  const Eigen::Array3f last = (size - VoxelIndex::Ones()).cast<float>();
  return p.array().floor().max(0.0f).min(last).cast<int>();
}

/// Part of a ray that lies in the box [0, size].
Span clipToBox(const Eigen::Vector3f& origin, const Eigen::Vector3f& ray, const VoxelIndex& size) {
  Span span;
  for (int axis = 0; axis < 3; ++axis) {
    clipToSlab(origin[axis], ray[axis], static_cast<float>(size[axis]), &span);
  }
  return span;
}

/// Of the cube of directions, voxel edges: bounds the memory that a scan of a long range needs.
constexpr int kMaxHalfSide = 512;

}  // namespace

RayCaster::RayCaster(const VoxelLattice& lattice, double end_cut, double min_hit_cover,
                     bool round_rays)
    : lattice_(lattice),
      end_cut_(static_cast<float>(end_cut)),
      hit_cover_(min_hit_cover),
      round_rays_(round_rays),
      kernels_(kernels()) {}

RayCount RayCaster::cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask) {
  mask->begin(box);
  RayCount count;
  if (box.empty()) return count;

  // Relative to the box, so that coordinates are small wherever the vehicle is.
  origin_ = (scan.origin / lattice_.resolution() - box.min.cast<double>()).cast<float>();
  const Eigen::Array3f size = mask->size().cast<float>();
  origin_is_inside_ = (origin_.array() >= 0.0f).all() && (origin_.array() <= size).all();
  listEnds(scan.misses, *mask, &misses_);
  listEnds(scan.returns, *mask, &returns_);
  touchColumns(mask);
  beginCube();
  markEnds(misses_, false, mask, &count);
  markEnds(returns_, true, mask, &count);
  slices_.carve(mask);
  count.hits -= hit_cover_.dropSlivers(scan, returns_, origin_, lattice_.resolution(), mask);
  return count;
}

/// Rays stay in the rectangle of columns around their ends and their origin.
void RayCaster::touchColumns(ScanMask* mask) const {
  if (misses_.high[0] < 0 && returns_.high[0] < 0) return;
  const VoxelIndex origin = nearestVoxel(origin_, mask->size());
  mask->touch(origin.x(), origin.y());
  for (const RayEnds* ends : {&misses_, &returns_}) {
    if (ends->high[0] < 0) continue;
    mask->touch(ends->low[0], ends->low[1]);
    mask->touch(ends->high[0], ends->high[1]);
  }
}

/// The cube reaches a little beyond the ends that are farthest along x or y.
void RayCaster::beginCube() {
  float farthest = 0.0f;
  for (const RayEnds* ends : {&misses_, &returns_}) {
    if (ends->high[0] < 0) continue;
    for (int axis = 0; axis < 2; ++axis) {
      farthest = std::max({farthest, origin_[axis] - (ends->low[axis] + 0.5f),
                           ends->high[axis] + 0.5f - origin_[axis]});
    }
  }
  cube_.half_side =
      static_cast<int>(std::min<float>(farthest + DirectionCube::kSlack, kMaxHalfSide - 1)) + 1;
  for (int axis = 0; axis < 3; ++axis) cube_.origin[axis] = origin_[axis];
  if (origin_is_inside_) slices_.begin(cube_);
}

/// Marks the voxels in which rays end, and hands the rays on, one for each of them.
void RayCaster::markEnds(const RayEnds& ends, bool are_returns, ScanMask* mask, RayCount* count) {
  constexpr int kBlock = 64;  // ends whose voxels may be marked by others of the block, too
  cut_rays_.clear();
  whole_rays_.clear();
  const VoxelBits marked = mask->bits(are_returns ? ScanMask::kHit : ScanMask::kMissEnd);
  std::int32_t unmarked[kBlock + kVectorRoom];
  for (int first = 0; first < ends.size; first += kBlock) {
    const int last = std::min(first + kBlock, ends.size);
    const int listed = kernels_.selectEnds(ends, first, last, marked, false, unmarked);
    for (int i = 0; i < listed; ++i) markEnd(ends, unmarked[i], are_returns, mask);
  }
  count->hits += cut_rays_.size();
  count->misses += whole_rays_.size();
  castRays(ends, &cut_rays_, end_cut_, mask);
  castRays(ends, &whole_rays_, 0.0f, mask);
}

void RayCaster::markEnd(const RayEnds& ends, std::int32_t k, bool are_returns, ScanMask* mask) {
  if (ends.z[k] == RayEnds::kMissesBox) return;
  const bool is_return = are_returns && ends.z[k] < RayEnds::kLeavesBox;
  const ScanMask::Layer layer = is_return ? ScanMask::kHit : ScanMask::kMissEnd;
  const int z = ends.z[k] % RayEnds::kLeavesBox;
  const std::int32_t word = mask->columnOffset(ends.x[k], ends.y[k]) + z / kWordBits;
  if (!mask->markEnd(layer, word, z % kWordBits)) return;
  (is_return ? cut_rays_ : whole_rays_).push_back(k);
}

/// Casts the rays to ends[k] for each k that is listed.
void RayCaster::castRays(const RayEnds& ends, std::vector<std::int32_t>* listed, float cut,
                         ScanMask* mask) {
  const int count = static_cast<int>(listed->size());
  if (!origin_is_inside_ || !round_rays_) {
    for (const std::int32_t k : *listed) castStraight(ends, k, cut, mask);
    return;
  }
  listed->resize(count + kVectorRoom);
  kernels_.roundRays(cube_, ends, listed->data(), count, cut, &rays_);
  for (int i = 0; i < count; ++i) {
    if (rays_.slice[i] == CubeRays::kStraight) {
      castStraight(ends, (*listed)[i], cut, mask);
    } else if (rays_.reach[i] > 0.0f) {
      slices_.add(rays_.slice[i], rays_.cell[i], rays_.reach[i]);
    }
  }
}

void RayCaster::listEnds(const PointList& points, const ScanMask& mask, RayEnds* ends) const {
  const float to_voxels = static_cast<float>(1.0 / lattice_.resolution());
  const int count = static_cast<int>(points.size());
  if (!origin_is_inside_) {
    // Rays that enter the box on their way are too rare for a kernel.
    ends->begin(count);
    for (const Eigen::Vector3f& point : points) listEnd(point * to_voxels, mask, ends);
    ends->first[ends->size] = ends->size;
    return;
  }
  EndPoints end_points;
  end_points.x = points.x();
  end_points.y = points.y();
  end_points.z = points.z();
  end_points.count = count;
  end_points.to_voxels = to_voxels;
  for (int axis = 0; axis < 3; ++axis) {
    end_points.origin[axis] = origin_[axis];
    end_points.size[axis] = mask.size()[axis];
  }
  kernels_.listEnds(end_points, ends);
}

/// Of a sensor anywhere.
void RayCaster::listEnd(const Eigen::Vector3f& ray, const ScanMask& mask, RayEnds* ends) const {
  const VoxelIndex& size = mask.size();
  const Eigen::Vector3f end = origin_ + ray;
  VoxelIndex v = nearestVoxel(end, size);  // its own, inside the box
  std::int32_t flag = 0;
  if (!((end.array() >= 0.0f).all() && (end.array() < size.cast<float>().array()).all())) {
    const Span span = clipToBox(origin_, ray, size);
    flag = span.empty() ? RayEnds::kMissesBox : RayEnds::kLeavesBox;
    v = span.empty() ? VoxelIndex::Zero() : nearestVoxel(origin_ + span.exit * ray, size);
  }
  if (flag != RayEnds::kMissesBox) {
    for (int axis = 0; axis < 2; ++axis) {
      ends->low[axis] = std::min(ends->low[axis], v[axis]);
      ends->high[axis] = std::max(ends->high[axis], v[axis]);
    }
  }
  ends->x[ends->size] = v.x();
  ends->y[ends->size] = v.y();
  ends->z[ends->size] = v.z() + flag;
  ends->first[ends->size] = ends->size;
  ++ends->size;
}

/// A ray whose direction is not rounded: straight to the centre of voxel ends[k].
void RayCaster::castStraight(const RayEnds& ends, std::int32_t k, float cut, ScanMask* mask) {
  const float rise = static_cast<float>(ends.z[k] % RayEnds::kLeavesBox) + 0.5f - origin_.z();
  const float t_end = endOfRay(ends.x[k], ends.y[k], rise, cut);
  walkTo(ends.x[k], ends.y[k], *mask);
  int columns = walk_.size;
  while (columns > 0 && walk_.t[columns - 1] > t_end) --columns;
  walk_.t[columns] = t_end;
  RayRuns ray;
  ray.column = walk_.column.data();
  ray.t = walk_.t.data();
  ray.columns = columns;
  ray.origin_z = origin_.z();
  ray.rise_low = ray.rise_high = &rise;
  ray.runs = 1;
  kernels_.freeRuns(ray, mask->size().z(), mask->column(ScanMask::kFree, 0, 0));
}

/// The line to the middle of the column where a ray ends, over the columns of the mask; t is 1
/// there.
void RayCaster::walkTo(int end_x, int end_y, const ScanMask& mask) {
  const int end[2] = {end_x, end_y};
  const float direction[2] = {end_x + 0.5f - origin_.x(), end_y + 0.5f - origin_.y()};
  const int offset[2] = {mask.columnOffset(1, 0), mask.columnOffset(0, 1)};
  const int major = std::abs(direction[0]) >= std::abs(direction[1]) ? 0 : 1;
  const int minor = 1 - major;
  Span span;
  for (int axis = 0; axis < 2; ++axis) {
    clipToSlab(origin_[axis], direction[axis], static_cast<float>(mask.size()[axis]), &span);
  }

  ColumnLine line;
  line.start_t = std::min(span.enter, 1.0f);
  line.end_t = 1.0f;
  const int start = std::clamp(floorToInt(origin_[major] + direction[major] * line.start_t), 0,
                               mask.size()[major] - 1);
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
  line.last_minor_cell = mask.size()[minor] - 1;
  line.first_column = start * offset[major];
  line.major_offset = step * offset[major];
  line.minor_offset = offset[minor];
  kernels_.walk(line, &walk_);
}

/// Where the ray to a voxel ends, before its cut; below 0 when it does not begin.
float RayCaster::endOfRay(int x, int y, float rise, float cut) const {
  const Eigen::Vector2f level = Eigen::Vector2f(x + 0.5f, y + 0.5f) - origin_.head<2>();
  const float length = std::sqrt(level.squaredNorm() + rise * rise);
  return length > 0.0f ? 1.0f - cut / length : (cut > 0.0f ? -1.0f : 1.0f);
}

}  // namespace fiimap
