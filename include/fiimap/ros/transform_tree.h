#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "fiimap/ros/pose_history.h"
#include "fiimap/ros/stamp_guard.h"

namespace fiimap {

/// A transform at a stamp, as far as it is known.
struct TransformAtStamp {
  PoseLookup lookup = PoseLookup::kNotYet;                            ///< whether it was found
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();  ///< when found
  double gap = 0.0;  ///< s, largest time between the transforms around the stamp on a moving link
  std::string why;   ///< in words, unless found
};

/// The TF tree of the last seconds: a tf2 buffer that refuses bad data silently, tells what is
/// missing and knows how far apart in time the transforms are that it interpolates between. A
/// transform whose stamp is far from those before it on its link waits for the next one, which
/// confirms it or not; one wrong stamp would make tf2 refuse all that follow. Not thread-safe.
class TransformTree {
 public:
  /// \param history how long transforms are kept, s.
  explicit TransformTree(double history);

  /// Adds a transform from /tf or /tf_static. Bad, repeated and too old ones are left out.
  /// \param other newest stamp of other messages: near or before it none is too far ahead.
  void add(const geometry_msgs::TransformStamped& transform, bool is_static,
           const ros::Time& other = ros::Time());
  /// Forgets everything but static transforms.
  void clear();

  /// Number of transforms that were left out, without those that only repeat a stamp.
  std::uint64_t refused() const { return refused_; }

  /// Transform that takes points from `source` to `target` at a stamp.
  /// \param max_gap largest time between transforms to interpolate between on a moving link, s.
  TransformAtStamp at(const std::string& target, const std::string& source, const ros::Time& stamp,
                      double max_gap) const;

 private:
  struct Link {
    std::set<ros::Time> stamps;  // of the last seconds
    StampGuard guard;
    std::optional<geometry_msgs::TransformStamped> doubtful;
  };

  void addMoving(const geometry_msgs::TransformStamped& transform, const ros::Time& other);
  void insert(const geometry_msgs::TransformStamped& transform);
  double largestGap(const std::string& target, const std::string& source,
                    const ros::Time& stamp) const;
  double gapOfLink(const std::string& parent, const std::string& child,
                   const ros::Time& stamp) const;

  double history_;
  tf2::BufferCore buffer_;
  std::map<std::string, Link> links_;  // that move, by child frame
  ros::Time newest_;                   // good stamp of any link
  std::uint64_t refused_ = 0;
};

}  // namespace fiimap
