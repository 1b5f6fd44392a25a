#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/pose_history.h"
#include "fiimap/ros/transform_tree.h"

namespace fiimap {

/// Pose of a sensor at a stamp, or why it is not known.
struct ResolvedPose {
  /// Whether the pose is known.
  enum class State {
    kFound,
    kPending,     ///< may be known later
    kImpossible,  ///< will never be known
  };

  State state = State::kPending;                            ///< all else depends on it
  Drop why;                                                 ///< unless found
  Eigen::Isometry3d T_W_S = Eigen::Isometry3d::Identity();  ///< sensor to world
  /// Body to world; where no body frame is known, the sensor's.
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  /// The sensor is not rotated on its body, or there is no body frame to tell.
  bool sensor_axes_like_body = true;
  double gap = 0.0;  ///< s between the poses around the stamp
};

/// Finds where sensors were, from the configured source of poses and extrinsics.
/// Not thread-safe.
class PoseResolver {
 public:
  /// \param config validated.
  explicit PoseResolver(const NodeConfig& config);
  /// Goes on with another max_pose_gap; \param config differs in what is `tunable` only.
  void reconfigure(const NodeConfig& config);

  ///@{
  /// Adds a pose of the body. One that cannot be used is counted and left out.
  void add(const nav_msgs::Odometry& odometry);
  void add(const geometry_msgs::PoseStamped& pose);
  void add(const geometry_msgs::TransformStamped& transform);
  ///@}
  /// Adds what came on /tf, or on /tf_static.
  /// \param other newest stamp of other messages, see TransformTree::add().
  void addTf(const tf2_msgs::TFMessage& transforms, bool is_static,
             const ros::Time& other = ros::Time());
  /// Counts a pose message that is not to be used.
  void refuse(const Drop& why);
  /// Forgets poses and moving transforms.
  void clear();

  /// Stamp of the newest pose message; zero when there is none.
  ros::Time newestPose() const { return history_.newest(); }
  /// Number of pose messages (not TF) that could not be used.
  std::uint64_t refusedPoses() const { return refused_poses_; }
  /// Number of transforms of TF that could not be used.
  std::uint64_t refusedTransforms() const { return tree_.refused(); }

  /// Where a sensor was.
  /// \param sensor_frame of its messages.
  ResolvedPose at(const SensorConfig& sensor, const std::string& sensor_frame,
                  const ros::Time& stamp) const;

 private:
  ResolvedPose withoutMessage(const PoseAtStamp& pose, const ros::Time& stamp) const;
  ResolvedPose sensorOnBody(const SensorConfig& sensor, const Eigen::Isometry3d& T_W_B, double gap,
                            const std::string& body_frame, const std::string& sensor_frame,
                            const ros::Time& stamp) const;
  ResolvedPose bodyFromTf(const SensorConfig& sensor, const std::string& sensor_frame,
                          const ros::Time& stamp) const;
  ResolvedPose sensorFromTf(const std::string& sensor_frame, const ros::Time& stamp) const;

  NodeConfig config_;
  PoseHistory history_;
  TransformTree tree_;
  std::optional<Drop> refused_;  // why the newest pose message could not be used
  std::uint64_t refused_poses_ = 0;
};

}  // namespace fiimap
