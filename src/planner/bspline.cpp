#include "bspline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fiimap {

Bspline::Bspline(Points control, double interval)
    : control_(std::move(control)), interval_(interval) {}

Bspline::Points Bspline::controlOf(const MotionState& state, double interval) {
  // Solves (a + 4 b + c) / 6 = position, (c - a) / 2 = velocity and a - 2 b + c = acceleration, in
  // units of the interval.
  const Eigen::Vector3d velocity = state.velocity * interval;
  const Eigen::Vector3d acceleration = state.acceleration * (interval * interval);
  const Eigen::Vector3d middle = state.position - acceleration / 6.0;
  return {middle - velocity + acceleration / 2.0, middle, middle + velocity + acceleration / 2.0};
}

MotionState Bspline::at(double time) const {
  const int segments = static_cast<int>(control_.size()) - kDegree;
  const double knots = std::clamp(time / interval_, 0.0, static_cast<double>(segments));
  const int first = std::min(static_cast<int>(knots), segments - 1);
  const double u = knots - first;
  const Eigen::Vector3d& a = control_[first];
  const Eigen::Vector3d& b = control_[first + 1];
  const Eigen::Vector3d& c = control_[first + 2];
  const Eigen::Vector3d& d = control_[first + 3];
  const double w = 1.0 - u;
  MotionState state;
  state.position = (w * w * w * a + (4.0 - 6.0 * u * u + 3.0 * u * u * u) * b +
                    (4.0 - 6.0 * w * w + 3.0 * w * w * w) * c + u * u * u * d) /
                   6.0;
  state.velocity =
      (w * w * (b - a) + (1.0 + 2.0 * u * w) * (c - b) + u * u * (d - c)) / (2.0 * interval_);
  state.acceleration = (w * (a - 2.0 * b + c) + u * (b - 2.0 * c + d)) / (interval_ * interval_);
  return state;
}

double Bspline::speedBound() const {
  // The Bezier points of the velocity, which lie closer to it than the differences themselves.
  double bound = 0.0;
  for (std::size_t i = 0; i + 3 < control_.size(); ++i) {
    const Eigen::Vector3d first = control_[i + 1] - control_[i];
    const Eigen::Vector3d middle = control_[i + 2] - control_[i + 1];
    const Eigen::Vector3d last = control_[i + 3] - control_[i + 2];
    bound = std::max(
        {bound, (first + middle).norm() / 2.0, middle.norm(), (middle + last).norm() / 2.0});
  }
  return bound / interval_;
}

double Bspline::accelerationBound() const {
  double bound = 0.0;
  for (std::size_t i = 0; i + 2 < control_.size(); ++i) {
    bound = std::max(bound, (control_[i] - 2.0 * control_[i + 1] + control_[i + 2]).norm());
  }
  return bound / (interval_ * interval_);
}

}  // namespace fiimap
