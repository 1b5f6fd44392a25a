#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <string>

#include "fiimap/ros/pose_history.h"

namespace fiimap {

struct TransformAtStamp {
  PoseLookup lookup = PoseLookup::kNotYet;
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();  ///< when found
  double gap = 0.0;  ///< s, largest time between the transforms around the stamp on a moving link
  std::string why;   ///< in words, unless found
};

/// The TF tree of the last seconds: a tf2 buffer that refuses bad data silently, tells what is
/// missing and knows how far apart in time the transforms are that it interpolates between.
/// Not thread-safe.
class TransformTree {
 public:
  /// \param history how long transforms are kept, s.
  explicit TransformTree(double history);

  /// Adds a transform from /tf or /tf_static. Bad, repeated and too old ones are left out.
  void add(const geometry_msgs::TransformStamped& transform, bool is_static);
  /// Forgets everything but static transforms.
  void clear();

  /// Transform that takes points from `source` to `target` at a stamp.
  /// \param max_gap largest time between transforms to interpolate between on a moving link, s.
  TransformAtStamp at(const std::string& target, const std::string& source, const ros::Time& stamp,
                      double max_gap) const;

 private:
  /// \return false when the stamp is known already or too old.
  bool remember(const std::string& child, const ros::Time& stamp);
  double largestGap(const std::string& target, const std::string& source,
                    const ros::Time& stamp) const;
  double gapOfLink(const std::string& parent, const std::string& child,
                   const ros::Time& stamp) const;

  double history_;
  tf2::BufferCore buffer_;
  std::map<std::string, std::set<ros::Time>> stamps_;  // of moving links, by child frame
};

}  // namespace fiimap
