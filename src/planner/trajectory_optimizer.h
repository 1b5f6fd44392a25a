#pragma once

#include <optional>

#include "bspline.h"
#include "flight_space.h"

namespace fiimap {

/// Limits of a trajectory.
struct MotionLimits {
  double speed = 1.0;         ///< m/s
  double acceleration = 1.0;  ///< m/s^2
};

/// Smooths a B-spline and pushes it out of obstacles, without a distance field: control points near
/// a part of the curve that is not free get a half space to be in, given by a point and a direction
/// that leads to a guide, a curve through free space. (The idea is ego-planner's; see
/// docs/planner.md.)
class TrajectoryOptimizer {
 public:
  struct Settings {
    MotionLimits limits;
    double clearance = 0.1;   ///< m
    double max_escape = 0.0;  ///< m, the first part of the curve that need not be free
  };

  TrajectoryOptimizer(const FlightSpace& space, const Settings& settings);

  /// \param guide curve whose control points lie on a free way; its first and last three stay.
  /// \return a curve with the same ends, knots and number of control points that is free all along;
  /// none when there was none after a bounded number of rounds. Limits are aimed at, not promised.
  std::optional<Bspline> optimize(const Bspline& guide);

 private:
  /// Control points must have (q - point) * direction >= clearance.
  struct HalfSpace {
    int control = 0;
    Eigen::Vector3d point, direction;
  };

  Bspline minimize(const Bspline& start) const;
  /// \return whether the curve is free all along; if not, adds half spaces where it is not.
  bool isFreeOrPushed(const Bspline& curve, const Bspline& guide);
  void push(int control, const Eigen::Vector3d& blocked_W, const Bspline& curve,
            const Bspline& guide);

  double cost(const Bspline::Points& control, double interval, Bspline::Points* gradient) const;
  void addSmoothness(const Bspline::Points& control, double* cost, Bspline::Points* gradient) const;
  void addClearance(const Bspline::Points& control, double* cost, Bspline::Points* gradient) const;
  void addLimits(const Bspline::Points& control, double interval, double* cost,
                 Bspline::Points* gradient) const;

  const FlightSpace& space_;
  Settings settings_;
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace fiimap
