#include "fiimap/ros/vehicle_path.h"

#include <cmath>

namespace fiimap {
namespace {

double distance(const geometry_msgs::PoseStamped& a, const geometry_msgs::PoseStamped& b) {
  const geometry_msgs::Point& p = a.pose.position;
  const geometry_msgs::Point& q = b.pose.position;
  return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
}

}  // namespace

void VehiclePath::add(const geometry_msgs::PoseStamped& pose) {
  if (!poses_.empty() && pose.header.stamp < poses_.back().header.stamp) return;
  const std::size_t size = poses_.size();
  // The newest pose stays for good only if it is far enough from the one before it.
  if (size >= 2 && distance(poses_[size - 2], poses_[size - 1]) < spacing_) poses_.pop_back();
  poses_.push_back(pose);
  if (poses_.size() > kMaxPoses) thin();
}

void VehiclePath::clear() { *this = VehiclePath(); }

void VehiclePath::thin() {
  std::vector<geometry_msgs::PoseStamped> kept;
  for (std::size_t i = 0; i + 1 < poses_.size(); i += 2) kept.push_back(poses_[i]);
  kept.push_back(poses_.back());
  poses_.swap(kept);
  spacing_ *= 2.0;
}

}  // namespace fiimap
