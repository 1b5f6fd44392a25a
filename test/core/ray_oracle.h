#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "oracle.h"

/// Exact reference of ray casting, by the definition in ray_caster.h: every voxel of the box
/// against every segment, in extended precision. Points are in voxel edges from the world's origin.
namespace fiimap::test {

using ExactPoint = Eigen::Matrix<long double, 3, 1>;

/// Voxels which a segment enters by less than this, in voxel edges, may be either: rounding
/// decides.
constexpr long double kRayTolerance = 1e-4L;

/// Part of the line from + t (to - from), t in [0, 1], in a closed box; nothing when it stays
/// outside.
struct Overlap {
  long double t_in, t_out;
};
inline std::optional<Overlap> overlap(const ExactPoint& from, const ExactPoint& to,
                                      const ExactPoint& low, const ExactPoint& high) {
  Overlap part{0.0L, 1.0L};
  for (int axis = 0; axis < 3; ++axis) {
    const long double direction = to[axis] - from[axis];
    if (direction == 0.0L) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return std::nullopt;
      continue;
    }
    const long double t_low = (low[axis] - from[axis]) / direction;
    const long double t_high = (high[axis] - from[axis]) / direction;
    part.t_in = std::max(part.t_in, std::min(t_low, t_high));
    part.t_out = std::min(part.t_out, std::max(t_low, t_high));
  }
  if (part.t_in > part.t_out) return std::nullopt;
  return part;
}

/// The same for a box of voxels whose faces are moved outwards by `grow`.
inline std::optional<Overlap> overlap(const ExactPoint& from, const ExactPoint& to,
                                      const VoxelBox& box, long double grow) {
  const ExactPoint border = ExactPoint::Constant(grow);
  return overlap(from, to, box.min.cast<long double>() - border,
                 box.max.cast<long double>() + border);
}

inline VoxelIndex voxelOf(const ExactPoint& point) { return point.array().floor().cast<int>(); }

inline ExactPoint centreOf(const VoxelIndex& v) {
  return v.cast<long double>() + ExactPoint::Constant(0.5L);
}

/// Whether a point lies so close to a voxel's face that rounding decides on which side it is.
inline bool nearFace(const ExactPoint& point, int ignored_axis = -1) {
  for (int axis = 0; axis < 3; ++axis) {
    const long double distance = std::abs(point[axis] - std::round(point[axis]));
    if (axis != ignored_axis && distance < kRayTolerance) return true;
  }
  return false;
}

/// What a scan must and may mark in a box. Rays are collected first: the grid of directions to
/// which they are rounded depends on all of them. All rays have one origin.
class RayOracle {
 public:
  RayOracle(const VoxelBox& box, long double end_cut, bool round_rays)
      : box_(box), end_cut_(end_cut), round_rays_(round_rays), must_free_(box), may_free_(box) {}

  /// \return false, and nothing is added, where rounding decides in which voxel the ray ends.
  bool addReturn(const ExactPoint& origin, const ExactPoint& end) {
    if (nearFace(end)) return false;
    const VoxelIndex v = voxelOf(end);
    if (!box_.contains(v)) return addLeaving(origin, end);
    hits_.insert(v);
    return true;
  }
  bool addMiss(const ExactPoint& origin, const ExactPoint& end) {
    if (nearFace(end)) return false;
    const VoxelIndex v = voxelOf(end);
    if (!box_.contains(v)) return addLeaving(origin, end);
    miss_ends_.insert(v);
    return true;
  }
  /// Half the side of the cube to which directions are rounded; nothing where rounding decides it.
  std::optional<int> halfSideOfCube(const ExactPoint& origin) const {
    constexpr long double kSlack = 0.25L;
    constexpr int kMost = 512;
    long double farthest = 0.0L;
    for (const auto* ends : {&hits_, &miss_ends_}) {
      for (const VoxelIndex& v : *ends) farthest = std::max(farthest, major(centreOf(v) - origin));
    }
    const auto half_side = static_cast<int>(farthest + kSlack);
    if (half_side != static_cast<int>(farthest + kSlack - kRayTolerance)) return std::nullopt;
    if (half_side != static_cast<int>(farthest + kSlack + kRayTolerance)) return std::nullopt;
    return std::min(half_side + 1, kMost);
  }
  /// To be called once, after the last ray: all of them begin at the origin.
  void cast(const ExactPoint& origin, int half_side) {
    origin_ = origin;
    for (const VoxelIndex& v : hits_) addRay(v, end_cut_, half_side);
    for (const VoxelIndex& v : miss_ends_) addRay(v, 0.0L, half_side);
  }

  const VoxelSet& hits() const { return hits_; }
  const VoxelSet& missEnds() const { return miss_ends_; }
  bool mustBeFree(const VoxelIndex& v) const { return must_free_.at(v); }
  bool mayBeFree(const VoxelIndex& v) const { return may_free_.at(v); }
  /// Whether rounding decides nothing.
  bool isExact() const { return must_free_ == may_free_; }

 private:
  bool addLeaving(const ExactPoint& origin, const ExactPoint& end) {
    const std::optional<Overlap> inside = overlap(origin, end, box_, -kRayTolerance);
    if (!inside) return !overlap(origin, end, box_, kRayTolerance);
    const std::optional<Overlap> part = overlap(origin, end, box_, 0.0L);
    const ExactPoint exit = origin + part->t_out * (end - origin);
    const VoxelIndex top = box_.max - VoxelIndex::Ones();
    int exit_axis = 0;
    const ExactPoint beyond = (exit - (box_.min + box_.max).cast<long double>() / 2).cwiseAbs() -
                              box_.size().cast<long double>() / 2;
    beyond.maxCoeff(&exit_axis);
    if (nearFace(exit, exit_axis)) return false;
    // The exit lies on a face of the box: its voxel is the one inside.
    VoxelIndex last = voxelOf(exit);
    last[exit_axis] = end[exit_axis] > origin[exit_axis] ? top[exit_axis] : box_.min[exit_axis];
    miss_ends_.insert(last);
    return true;
  }

  /// Distance of an end from the origin along the horizontal axis along which it is farther.
  static long double major(const ExactPoint& ray) {
    return std::max(std::abs(ray.x()), std::abs(ray.y()));
  }
  /// Whether the direction of a ray is rounded; with a tolerance for either answer.
  bool isRounded(const ExactPoint& ray, int half_side, long double tolerance) const {
    const auto from_low = (origin_ - box_.min.cast<long double>()).array();
    const auto to_high = (box_.max.cast<long double>() - origin_).array();
    const bool is_inside = (from_low >= -tolerance).all() && (to_high >= -tolerance).all();
    return round_rays_ && is_inside && major(ray) > 0.0L &&
           major(ray) <= half_side - 0.25L + tolerance &&
           std::abs(ray.z()) <= major(ray) + tolerance;
  }

  /// The whole numbers to which a coordinate may be rounded.
  static std::vector<long double> roundings(long double value) {
    std::vector<long double> all = {std::floor(value + 0.5L - kRayTolerance)};
    const long double other = std::floor(value + 0.5L + kRayTolerance);
    if (other != all[0]) all.push_back(other);
    return all;
  }

  /// The ends that the ray may be rounded to; one, where rounding errors decide nothing.
  std::vector<ExactPoint> roundedEnds(const ExactPoint& ray, int half_side) const {
    std::vector<ExactPoint> ends;
    if (!isRounded(ray, half_side, -kRayTolerance)) ends.push_back(origin_ + ray);
    if (!isRounded(ray, half_side, kRayTolerance)) return ends;
    for (int axis = 0; axis < 2; ++axis) {
      const int minor = 1 - axis;
      const long double distance = std::abs(ray[axis]);
      if (distance < std::abs(ray[minor]) - kRayTolerance) continue;
      for (const long double j : roundings(ray[minor] / distance * half_side)) {
        for (const long double k : roundings(ray.z() / distance * half_side)) {
          ExactPoint rounded = ray;
          rounded[minor] = j / half_side * distance;
          rounded.z() = k / half_side * distance;
          ends.push_back(origin_ + rounded);
        }
      }
    }
    return ends;
  }

  void addRay(const VoxelIndex& v, long double cut, int half_side) {
    const ExactPoint ray = centreOf(v) - origin_;
    const long double length = ray.norm();
    if (cut > 0.0L && cut >= length) return;
    const std::vector<ExactPoint> ends = roundedEnds(ray, half_side);
    for (const ExactPoint& end : ends) {
      const ExactPoint to = cut > 0.0L ? (end - (end - origin_) * (cut / length)).eval() : end;
      addSegment(to, ends.size() == 1);
    }
  }

  void addSegment(const ExactPoint& to, bool is_certain) {
    const VoxelIndex border = VoxelIndex::Ones();
    const VoxelBox around{voxelOf(origin_.cwiseMin(to)) - border,
                          voxelOf(origin_.cwiseMax(to)) + 2 * border};
    forEachVoxel(around.intersection(box_), [&](const VoxelIndex& v) {
      const VoxelBox voxel{v, v + border};
      if (overlap(origin_, to, voxel, kRayTolerance)) may_free_.mark(v);
      if (is_certain && overlap(origin_, to, voxel, -kRayTolerance)) must_free_.mark(v);
    });
  }

  VoxelBox box_;
  long double end_cut_;
  bool round_rays_;
  ExactPoint origin_ = ExactPoint::Zero();
  VoxelSet hits_, miss_ends_;
  VoxelField must_free_, may_free_;
};

}  // namespace fiimap::test
