#include "trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fiimap {
namespace {

constexpr double kHoverInterval = 1e-3;  // s; any will do
constexpr double kSlowSpeed = 0.1;       // m/s; braking at less takes as long as at this speed
constexpr double kStepsPerVoxel = 2.0;

double maxSpeed(const Bspline& curve, double from, double to) {
  constexpr int kSamples = 50;
  double speed = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    speed = std::max(speed, curve.at(from + (to - from) * i / kSamples).velocity.norm());
  }
  return speed;
}

}  // namespace

Trajectory::Trajectory(Bspline curve, double start_time)
    : curve_(std::move(curve)), start_time_(start_time) {}

Trajectory Trajectory::hover(const Eigen::Vector3d& position, double time,
                             std::optional<double> heading) {
  Trajectory hover({Bspline::Points(Bspline::kDegree + 1, position), kHoverInterval},
                   time - kHoverInterval);
  hover.heading_ = heading;
  return hover;
}

Trajectory Trajectory::braked(double time, double deceleration) const {
  if (isBraking() || time >= endTime()) return *this;
  Trajectory braked = *this;
  braked.brake_time_ = std::max(time, start_time_);
  // The way to rest takes 1 / (2 slowing) of the curve's time; the speed there bounds the slowing,
  // which may need more of it.
  const double begin = braked.brake_time_ - start_time_;
  double speed = std::max(kSlowSpeed, curve_.at(begin).velocity.norm());
  double previous = 0.0;
  while (speed > previous) {
    previous = speed;
    braked.slowing_ = deceleration / speed;
    speed = std::max(speed, maxSpeed(curve_, begin, begin + 0.5 / braked.slowing_));
  }
  return braked;
}

double Trajectory::endTime() const {
  const double end = start_time_ + curve_.duration();
  return isBraking() ? std::min(end, brake_time_) + 1.0 / slowing_ : end;
}

MotionState Trajectory::at(double time) const {
  double curve_time = time - start_time_;
  double rate = 1.0, change_of_rate = 0.0;
  if (time >= brake_time_) {
    const double braking = std::min(time - brake_time_, 1.0 / slowing_);
    curve_time = brake_time_ - start_time_ + braking - 0.5 * slowing_ * braking * braking;
    rate = 1.0 - slowing_ * braking;
    change_of_rate = -slowing_;
  }
  MotionState state = curve_.at(curve_time);
  const bool rests = curve_time < 0.0 || curve_time > curve_.duration() || rate <= 0.0;
  if (rests) {
    // Before its start a trajectory is the state with which it starts.
    if (curve_time >= 0.0)
      state = {state.position, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    return state;
  }
  state.acceleration = rate * rate * state.acceleration + change_of_rate * state.velocity;
  state.velocity *= rate;
  return state;
}

std::optional<double> firstCollision(const Trajectory& trajectory, const FlightSpace& space,
                                     const TimeSpan& span, double max_escape) {
  const double step =
      space.resolution() / kStepsPerVoxel / std::max(kSlowSpeed, trajectory.curve().speedBound());
  Eigen::Vector3d position = trajectory.at(span.from).position;
  const bool has_start = space.lattice().canIndex(position);
  // A vehicle that is where the map has an obstacle has to leave that voxel, too.
  const VoxelIndex start =
      has_start ? space.lattice().indexOf(position) : VoxelIndex(VoxelIndex::Zero());
  bool escaping = !space.isFree(position);
  double escaped = 0.0;
  // At least one point is looked at, also of a hover that has long begun.
  const double end = std::max(trajectory.endTime(), span.from) + step;
  for (double time = span.from; time < std::min(end, span.until); time += step) {
    const Eigen::Vector3d next = trajectory.at(time + step).position;
    if (escaping) {
      escaped += (next - position).norm();
      escaping = !space.isFree(next);
      const bool crosses = has_start && space.lattice().canIndex(next) &&
                           (!escaping || space.lattice().indexOf(next) == start ||
                            space.isCrossable(space.lattice().indexOf(next)));
      if (!crosses || escaped > max_escape) return time;
    } else if (!space.isLineFree(position, next)) {
      return time;
    }
    position = next;
  }
  const bool stays = escaping && span.until >= end;
  return stays ? std::optional(span.from) : std::nullopt;
}

}  // namespace fiimap
