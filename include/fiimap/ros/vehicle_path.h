#pragma once

#include <geometry_msgs/PoseStamped.h>

#include <vector>

namespace fiimap {

/// Where a vehicle was: the newest pose and, some distance apart, those before it. Of bounded
/// length: when it is full, every second pose goes and the distance doubles. Not thread-safe.
class VehiclePath {
 public:
  static constexpr double kSpacing = 0.1;         ///< m, as long as the path is short
  static constexpr std::size_t kMaxPoses = 1000;  ///< at any time

  /// Leaves out what is older than the newest: a sensor whose scans take longer.
  void add(const geometry_msgs::PoseStamped& pose);
  /// Forgets all poses.
  void clear();

  /// Oldest first.
  const std::vector<geometry_msgs::PoseStamped>& poses() const { return poses_; }

 private:
  void thin();

  std::vector<geometry_msgs::PoseStamped> poses_;
  double spacing_ = kSpacing;
};

}  // namespace fiimap
