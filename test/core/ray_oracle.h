#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

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

/// What a scan must and may mark in a box.
class RayOracle {
 public:
  RayOracle(const VoxelBox& box, long double end_cut)
      : box_(box), end_cut_(end_cut), must_free_(box), may_free_(box) {}

  /// \return false, and nothing is added, where rounding decides in which voxel the ray ends.
  bool addReturn(const ExactPoint& origin, const ExactPoint& end) {
    if (nearFace(end)) return false;
    const VoxelIndex v = voxelOf(end);
    if (!box_.contains(v)) return addLeaving(origin, end);
    hits_.insert(v);
    addSegment(origin, centreOf(v), end_cut_);
    return true;
  }
  bool addMiss(const ExactPoint& origin, const ExactPoint& end) {
    if (nearFace(end)) return false;
    const VoxelIndex v = voxelOf(end);
    if (!box_.contains(v)) return addLeaving(origin, end);
    addMissIn(v, origin);
    return true;
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
    addMissIn(last, origin);
    return true;
  }

  void addMissIn(const VoxelIndex& v, const ExactPoint& origin) {
    miss_ends_.insert(v);
    addSegment(origin, centreOf(v), 0.0L);
  }

  void addSegment(const ExactPoint& from, const ExactPoint& centre, long double cut) {
    const long double length = (centre - from).norm();
    if (cut > 0.0L && cut >= length) return;
    const ExactPoint to = cut > 0.0L ? (centre - (centre - from) * (cut / length)).eval() : centre;
    const VoxelIndex border = VoxelIndex::Ones();
    const VoxelBox around{voxelOf(from.cwiseMin(to)) - border,
                          voxelOf(from.cwiseMax(to)) + 2 * border};
    forEachVoxel(around.intersection(box_), [&](const VoxelIndex& v) {
      const VoxelBox voxel{v, v + border};
      if (overlap(from, to, voxel, kRayTolerance)) may_free_.mark(v);
      if (overlap(from, to, voxel, -kRayTolerance)) must_free_.mark(v);
    });
  }

  VoxelBox box_;
  long double end_cut_;
  VoxelSet hits_, miss_ends_;
  VoxelField must_free_, may_free_;
};

}  // namespace fiimap::test
