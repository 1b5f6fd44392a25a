#include "guide_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fiimap {

Polyline::Polyline(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
  lengths_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

Eigen::Vector3d Polyline::at(double length) const {
  const auto after = std::upper_bound(lengths_.begin(), lengths_.end(), length);
  if (after == lengths_.begin()) return points_.front();
  if (after == lengths_.end()) return points_.back();
  const std::size_t i = static_cast<std::size_t>(after - lengths_.begin());
  const double share = (length - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

Polyline throughCenters(const VoxelPath& path, const Eigen::Vector3d& start,
                        const Eigen::Vector3d& end, const VoxelLattice& lattice) {
  std::vector<Eigen::Vector3d> points{start};
  for (const VoxelIndex& v : path.voxels) points.push_back(lattice.centerOf(v));
  points.push_back(end);
  return Polyline(std::move(points));
}

Polyline shortcut(const Polyline& line, const FlightSpace& space, std::size_t kept) {
  const std::vector<Eigen::Vector3d>& points = line.points();
  std::vector<Eigen::Vector3d> corners(
      points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min(kept, points.size())));
  std::size_t anchor = corners.empty() ? 0 : corners.size() - 1;
  if (corners.empty()) corners.push_back(points.front());
  while (anchor + 1 < points.size()) {
    std::size_t next = anchor + 1;
    while (next + 1 < points.size() && space.isLineFree(points[anchor], points[next + 1])) ++next;
    corners.push_back(points[next]);
    anchor = next;
  }
  return Polyline(std::move(corners));
}

SpeedProfile::SpeedProfile(double length, double initial_speed, double cruise, double acceleration)
    : length_(length), initial_speed_(initial_speed) {
  // Without cruising, speeding up and slowing down would just fill the way.
  const double peak = std::sqrt(acceleration * length + initial_speed * initial_speed / 2.0);
  if (peak <= initial_speed) {
    top_speed_ = initial_speed;
    speed_up_ = cruise_ = 0.0;
    slow_down_ = initial_speed > 0.0 ? 2.0 * length / initial_speed : 0.0;
    return;
  }
  top_speed_ = std::min(cruise, peak);
  speed_up_ = std::abs(top_speed_ - initial_speed) / acceleration;
  slow_down_ = top_speed_ / acceleration;
  const double ramps =
      speed_up_ * (initial_speed + top_speed_) / 2.0 + slow_down_ * top_speed_ / 2.0;
  cruise_ = std::max(0.0, length - ramps) / top_speed_;
}

double SpeedProfile::at(double time) const {
  const double up = std::clamp(time, 0.0, speed_up_);
  const double change = speed_up_ > 0.0 ? (top_speed_ - initial_speed_) / speed_up_ : 0.0;
  const double level = std::clamp(time - speed_up_, 0.0, cruise_);
  const double down = std::clamp(time - speed_up_ - cruise_, 0.0, slow_down_);
  const double drop = slow_down_ > 0.0 ? top_speed_ / slow_down_ : 0.0;
  const double way = initial_speed_ * up + 0.5 * change * up * up + top_speed_ * level +
                     top_speed_ * down - 0.5 * drop * down * down;
  return std::min(way, length_);
}

}  // namespace fiimap
