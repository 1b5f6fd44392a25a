#include "fiimap/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fiimap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Part [enter, exit] of the ray origin + t * direction, t in [0, 1], that lies in [0, size].
struct Span {
  double enter = 0.0;
  double exit = 1.0;
  bool empty() const { return enter > exit; }
};

void clipToSlab(double origin, double direction, double size, Span* span) {
  if (direction == 0.0) {
    if (origin < 0.0 || origin > size) *span = {1.0, 0.0};
    return;
  }
  const double t_low = -origin / direction;
  const double t_high = (size - origin) / direction;
  span->enter = std::max(span->enter, std::min(t_low, t_high));
  span->exit = std::min(span->exit, std::max(t_low, t_high));
}

/// Voxel of the box that holds a point on the box's surface, or just off it by rounding.
VoxelIndex nearestVoxel(const Eigen::Vector3d& p, const VoxelIndex& size) {
  const VoxelIndex v = p.array().floor().cast<int>();
  return v.cwiseMax(0).cwiseMin(size - VoxelIndex::Ones());
}

/// Part of a ray that lies in the box [0, size].
Span clipToBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, const VoxelIndex& size) {
  Span span;
  for (int axis = 0; axis < 3; ++axis) clipToSlab(origin[axis], ray[axis], size[axis], &span);
  return span;
}

/// Without SSE4.1, std::floor is a function call, and this is called at every column of a ray.
int floorToInt(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

}  // namespace

RayCaster::RayCaster(const VoxelLattice& lattice, double end_cut)
    : lattice_(lattice), end_cut_(end_cut) {}

RayCount RayCaster::cast(const RangeData& scan, const VoxelBox& box, ScanMask* mask) {
  mask->begin(box);
  RayCount count;
  if (box.empty()) return count;

  // Relative to the box, so that coordinates are small wherever the vehicle is.
  origin_ = scan.origin / lattice_.resolution() - box.min.cast<double>();
  end_columns_.clear();
  markEnds(scan, mask, &count);
  for (const Eigen::Vector2i& column : end_columns_) {
    walkTo(column.x(), column.y(), *mask);
    mask->touch(walk_.front().x, walk_.front().y);
    mask->touch(walk_.back().x, walk_.back().y);
    carve(column.x(), column.y(), mask);
  }
  return count;
}

void RayCaster::markEnds(const RangeData& scan, ScanMask* mask, RayCount* count) {
  const double to_voxels = 1.0 / lattice_.resolution();
  for (const Eigen::Vector3f& end : scan.returns) {
    markEnd(end.cast<double>() * to_voxels, true, mask, count);
  }
  for (const Eigen::Vector3f& end : scan.misses) {
    markEnd(end.cast<double>() * to_voxels, false, mask, count);
  }
}

void RayCaster::markEnd(const Eigen::Vector3d& ray, bool is_return, ScanMask* mask,
                        RayCount* count) {
  const VoxelIndex& size = mask->size();
  const Eigen::Vector3d end = origin_ + ray;
  VoxelIndex v = end.cast<int>();  // the floor, inside the box
  if (!((end.array() >= 0.0).all() && (end.array() < size.cast<double>().array()).all())) {
    const Span span = clipToBox(origin_, ray, size);
    if (span.empty()) return;
    v = nearestVoxel(origin_ + span.exit * ray, size);
    is_return = false;
  }
  const ScanMask::Layer layer = is_return ? ScanMask::kHit : ScanMask::kMissEnd;
  if (mask->test(layer, v)) return;
  if (!mask->any(ScanMask::kHit, v.x(), v.y()) && !mask->any(ScanMask::kMissEnd, v.x(), v.y())) {
    end_columns_.emplace_back(v.x(), v.y());
  }
  mask->mark(layer, v);
  ++(is_return ? count->hits : count->misses);
}

void RayCaster::walkTo(int end_x, int end_y, const ScanMask& mask) {
  walk_.clear();
  const Eigen::Vector2d end(end_x + 0.5, end_y + 0.5);
  const Eigen::Vector2d direction = end - origin_.head<2>();
  Span span;
  for (int axis = 0; axis < 2; ++axis) {
    clipToSlab(origin_[axis], direction[axis], mask.size()[axis], &span);
  }
  const Eigen::Vector2d start = origin_.head<2>() + span.enter * direction;

  int cell[2], step[2], steps_left[2];
  double t_next[2], t_delta[2];
  const int end_cell[2] = {end_x, end_y};
  for (int axis = 0; axis < 2; ++axis) {
    cell[axis] = std::clamp(floorToInt(start[axis]), 0, mask.size()[axis] - 1);
    step[axis] = end_cell[axis] > cell[axis] ? 1 : -1;
    steps_left[axis] = std::abs(end_cell[axis] - cell[axis]);
    const double boundary = cell[axis] + (step[axis] > 0 ? 1.0 : 0.0);
    const bool crosses = steps_left[axis] > 0;
    t_next[axis] = crosses ? (boundary - origin_[axis]) / direction[axis] : kInfinity;
    t_delta[axis] = crosses ? step[axis] / direction[axis] : kInfinity;
  }

  double t = span.enter;
  while (steps_left[0] + steps_left[1] > 0) {
    const int axis = t_next[0] < t_next[1] ? 0 : 1;
    const double t_out = std::clamp(t_next[axis], t, 1.0);
    walk_.push_back({cell[0], cell[1], t, t_out});
    t = t_out;
    cell[axis] += step[axis];
    t_next[axis] = --steps_left[axis] > 0 ? t_next[axis] + t_delta[axis] : kInfinity;
  }
  walk_.push_back({cell[0], cell[1], t, 1.0});
}

void RayCaster::carve(int end_x, int end_y, ScanMask* mask) const {
  for (const ScanMask::Layer layer : {ScanMask::kHit, ScanMask::kMissEnd}) {
    const double cut = layer == ScanMask::kHit ? end_cut_ : 0.0;
    forEachRun(mask->column(layer, end_x, end_y), mask->wordsPerColumn(),
               [&](int z_low, int z_high) { carveFan(z_low, z_high, cut, end_x, end_y, mask); });
  }
}

void RayCaster::carveFan(int z_low, int z_high, double cut, int end_x, int end_y,
                         ScanMask* mask) const {
  // The shortest ray of the fan is cut off first; up to there all rays pass together.
  const int z_nearest = std::clamp(floorToInt(origin_.z()), z_low, z_high);
  const double t_together = endOfRay(end_x, end_y, z_nearest, cut);
  const double rise_low = z_low + 0.5 - origin_.z();
  const double rise_high = z_high + 0.5 - origin_.z();

  std::size_t i = 0;
  for (; i < walk_.size() && walk_[i].t_out <= t_together; ++i) {
    const Crossing& c = walk_[i];
    const double lowest = origin_.z() + rise_low * (rise_low < 0.0 ? c.t_out : c.t_in);
    const double highest = origin_.z() + rise_high * (rise_high < 0.0 ? c.t_in : c.t_out);
    mask->markFreeRun(c.x, c.y, floorToInt(lowest), floorToInt(highest));
  }
  for (int z = z_low; z <= z_high; ++z) {
    const double t_end = endOfRay(end_x, end_y, z, cut);
    const double rise = z + 0.5 - origin_.z();
    for (std::size_t j = i; j < walk_.size() && walk_[j].t_in <= t_end; ++j) {
      const Crossing& c = walk_[j];
      const double z_in = origin_.z() + rise * c.t_in;
      const double z_out = origin_.z() + rise * std::min(c.t_out, t_end);
      mask->markFreeRun(c.x, c.y, floorToInt(std::min(z_in, z_out)),
                        floorToInt(std::max(z_in, z_out)));
    }
  }
}

double RayCaster::endOfRay(int end_x, int end_y, int z, double cut) const {
  const Eigen::Vector3d end(end_x + 0.5, end_y + 0.5, z + 0.5);
  const double length = (end - origin_).norm();
  return length > 0.0 ? 1.0 - cut / length : (cut > 0.0 ? -1.0 : 1.0);
}

}  // namespace fiimap
