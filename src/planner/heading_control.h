#pragma once

#include <optional>

#include "flown_trajectory.h"

namespace fiimap {

/// Where a vehicle looks while it flies a trajectory: ahead, turning no faster than a limit,
/// because its sensor sees what is ahead. Not thread-safe.
class HeadingControl {
 public:
  /// \param max_rate rad/s.
  explicit HeadingControl(double max_rate) : max_rate_(max_rate) {}

  /// Starts anew with what the vehicle has.
  void reset(double yaw) { yaw_ = yaw; }

  /// Turns on by a time step.
  /// \param time, period s. \return yaw, rad.
  double update(const FlownTrajectory& flown, double time, double period);

  double yaw() const { return yaw_; }
  double rate() const { return rate_; }  ///< rad/s

 private:
  double max_rate_;
  double yaw_ = 0.0;
  double rate_ = 0.0;
};

}  // namespace fiimap
