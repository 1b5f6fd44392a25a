#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <message_filters/cache.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

namespace fiimap {

/// Outcome of asking for a pose at a stamp.
enum class PoseLookup {
  kFound,
  kNotYet,  ///< newer than everything known: wait
  kTooOld,  ///< older than everything kept
  kGap,     ///< the poses around the stamp are too far apart in time
};

/// The pose of the body at a stamp, as far as it is known.
struct PoseAtStamp {
  PoseLookup lookup = PoseLookup::kNotYet;                  ///< whether it was found
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();  ///< body to world, when found
  std::string body_frame;                                   ///< child frame of the pose, when found
  double gap = 0.0;  ///< s between the poses around the stamp, when found or kGap
};

/// Translation and normalised rotation of a transform message.
/// \throws InputError (kBadPose) when it is not finite or its quaternion is not nearly of norm 1.
Eigen::Isometry3d decodeTransform(const geometry_msgs::Transform& transform);

/// Poses of the last seconds, interpolated at any stamp between them. Not thread-safe.
class PoseHistory {
 public:
  /// \param history how long poses are kept, s; \param max_gap largest time between two poses
  /// between which a pose is interpolated, s.
  PoseHistory(double history, double max_gap);

  /// Poses may come out of order and twice.
  /// \throws InputError (kZeroStamp, kBadPose); the pose is left out then.
  void add(const geometry_msgs::TransformStamped& pose);
  /// Forgets all poses.
  void clear();
  void setMaxGap(double max_gap) { max_gap_ = max_gap; }  ///< s, as at the start

  /// Whether there is no pose.
  bool empty() const { return newest().isZero(); }
  /// Stamp of the newest pose; zero when there is none.
  ros::Time newest() const { return cache_->getLatestTime(); }

  /// Stamp of the oldest pose that is kept; zero when there is none.
  ros::Time oldest() const { return cache_->getOldestTime(); }

  /// Pose at a stamp: position linear, orientation slerp between the poses around it.
  PoseAtStamp at(const ros::Time& stamp) const;

 private:
  using Cache = message_filters::Cache<geometry_msgs::TransformStamped>;

  double history_;
  double max_gap_;
  std::unique_ptr<Cache> cache_;
};

}  // namespace fiimap
