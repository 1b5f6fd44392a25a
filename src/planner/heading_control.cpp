#include "heading_control.h"

#include <algorithm>
#include <cmath>

namespace fiimap {
namespace {

constexpr double kHeadingLead = 0.8;  // s
constexpr double kMinWay = 0.15;      // m, in that time: else there is no direction to speak of

std::optional<double> wantedHeading(const FlownTrajectory& flown, double time) {
  const Trajectory& trajectory = flown.at(time);
  if (trajectory.heading()) return trajectory.heading();
  const double later = time + kHeadingLead;
  const Eigen::Vector3d way = flown.at(later).at(later).position - trajectory.at(time).position;
  if (way.head<2>().norm() < kMinWay) return std::nullopt;
  return std::atan2(way.y(), way.x());
}

}  // namespace

double HeadingControl::update(const FlownTrajectory& flown, double time, double period) {
  const std::optional<double> wanted = wantedHeading(flown, time);
  const double error = wanted ? std::remainder(*wanted - yaw_, 2.0 * M_PI) : 0.0;
  const double turn = std::clamp(error, -max_rate_ * period, max_rate_ * period);
  rate_ = period > 0.0 ? turn / period : 0.0;
  yaw_ = std::remainder(yaw_ + turn, 2.0 * M_PI);
  return yaw_;
}

}  // namespace fiimap
