#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "bspline.h"
#include "flight_space.h"

namespace fiimap {

/// A curve flown from a moment on, with rest at its end; possibly slowed down to rest on the way.
/// Times are seconds of the planner's clock. Immutable; safe to share between threads.
class Trajectory {
 public:
  Trajectory(Bspline curve, double start_time);

  /// Rest at a point.
  /// \param heading direction to look to, rad from the x axis of the map; none: as it is.
  static Trajectory hover(const Eigen::Vector3d& position, double time,
                          std::optional<double> heading = {});

  /// The same way, but slowed down to rest from `time` on. Along the way the deceleration is at
  /// most `deceleration`, m/s^2; across it, the curve's own acceleration only shrinks. The
  /// acceleration may jump at `time`, position and velocity do not. One that brakes already stays
  /// as it is.
  Trajectory braked(double time, double deceleration) const;

  double startTime() const { return start_time_; }
  /// When it is at rest.
  double endTime() const;
  bool isBraking() const { return slowing_ > 0.0; }
  const std::optional<double>& heading() const { return heading_; }
  const Bspline& curve() const { return curve_; }

  /// Before the start the state there, after the end rest.
  MotionState at(double time) const;

 private:
  Bspline curve_;
  double start_time_;
  std::optional<double> heading_;
  // While it brakes, time on the curve runs ever slower: at the rate 1 - slowing * (t -
  // brake_time).
  double brake_time_ = std::numeric_limits<double>::infinity();
  double slowing_ = 0.0;  ///< 1/s
};

struct TimeSpan {
  double from = 0.0;                                       ///< s
  double until = std::numeric_limits<double>::infinity();  ///< s
};

/// When a trajectory first leaves free space within a time span, s; none: never.
/// Checked along the voxels of a chain of lines whose corners lie on the trajectory, at most half a
/// voxel apart. The trajectory may begin in a place that is not free: then it must reach free space
/// within `max_escape` metres of way, through no occupied voxel but its first, before it ends.
std::optional<double> firstCollision(const Trajectory& trajectory, const FlightSpace& space,
                                     const TimeSpan& span, double max_escape);

}  // namespace fiimap
