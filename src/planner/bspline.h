#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/StdVector>

namespace fiimap {

/// Motion of a point at one moment, in the map frame.
struct MotionState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2
};

/// Uniform cubic B-spline over time: position, velocity and acceleration are continuous. Between
/// two knots the curve lies in the convex hull of four control points, and likewise its velocity
/// and acceleration in those of the differences of control points.
class Bspline {
 public:
  using Points = std::vector<Eigen::Vector3d>;

  static constexpr int kDegree = 3;

  /// \param control at least kDegree + 1 points, m.
  /// \param interval time between two knots, s, > 0.
  Bspline(Points control, double interval);

  /// The three control points with which a curve begins in a state (or ends in it).
  static Points controlOf(const MotionState& state, double interval);

  double interval() const { return interval_; }
  const Points& control() const { return control_; }
  double duration() const { return interval_ * (static_cast<int>(control_.size()) - kDegree); }

  /// \param time s from the beginning; clamped to [0, duration()].
  MotionState at(double time) const;

  /// Bounds of the speed and of the size of the acceleration on the whole curve, by its convex
  /// hulls: never less than what is flown.
  double speedBound() const;
  double accelerationBound() const;

 private:
  Points control_;
  double interval_;
};

}  // namespace fiimap
