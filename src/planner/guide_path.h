#pragma once

#include <vector>

#include "bspline.h"
#include "flight_space.h"
#include "path_search.h"

namespace fiimap {

/// A chain of straight lines, by length.
class Polyline {
 public:
  /// \param points at least one.
  explicit Polyline(std::vector<Eigen::Vector3d> points);

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  double length() const { return lengths_.back(); }
  /// Point at a length from the beginning, m; clamped to [0, length()].
  Eigen::Vector3d at(double length) const;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> lengths_;  ///< from the beginning to each point
};

/// The centres of a path's voxels between a start in the first voxel and an end in the last one.
Polyline throughCenters(const VoxelPath& path, const Eigen::Vector3d& start,
                        const Eigen::Vector3d& end, const VoxelLattice& lattice);

/// The same way with straight lines through free space instead of corners where there are any. The
/// first `kept` points stay.
Polyline shortcut(const Polyline& line, const FlightSpace& space, std::size_t kept);

/// How fast to fly along a way: from a speed to a cruising speed and to rest at the end, with
/// constant accelerations. A way too short to stop on is stopped on harder.
class SpeedProfile {
 public:
  /// Metres, m/s, m/s^2; `cruise` and `acceleration` > 0.
  SpeedProfile(double length, double initial_speed, double cruise, double acceleration);

  double duration() const { return speed_up_ + cruise_ + slow_down_; }
  /// Way after a time, m.
  double at(double time) const;

 private:
  double length_, initial_speed_, top_speed_;
  double speed_up_, cruise_, slow_down_;  ///< durations, s
};

}  // namespace fiimap
