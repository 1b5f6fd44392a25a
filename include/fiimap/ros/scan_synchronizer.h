#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "fiimap/depth_projector.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/camera_setup_check.h"
#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/pose_resolver.h"
#include "fiimap/ros/stamp_guard.h"

namespace fiimap {

using ScanMessage = std::variant<sensor_msgs::ImageConstPtr, sensor_msgs::PointCloud2ConstPtr>;
using PoseMessage =
    std::variant<nav_msgs::Odometry, geometry_msgs::PoseStamped, geometry_msgs::TransformStamped>;

/// A moment by two clocks.
struct Moment {
  ros::Time ros;  ///< simulated time in a replay
  std::chrono::steady_clock::time_point steady;
};

/// A scan with all that is needed to integrate it.
struct SynchronizedScan {
  ScanMessage message;
  PinholeIntrinsics intrinsics;  ///< of images only
  ScanPose pose;
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();  ///< vehicle's body to world
  double pose_gap = 0.0;                                    ///< s between the poses around the scan
};

/// Receives what a ScanSynchronizer finds, from within the call that caused it.
class ScanListener {
 public:
  virtual ~ScanListener() = default;

  virtual void onScan(const SynchronizedScan& scan) = 0;
  virtual void onDrop(const Drop& drop) = 0;
  /// Stamps went back (a bag began again): what was mapped before must be forgotten.
  virtual void onTimeJump(const std::string& what) = 0;
  /// Something that a user should know, once each.
  virtual void onWarning(const std::string& text) = 0;
};

/// Brings scans, poses, transforms and intrinsics together by their stamps, in whatever order they
/// arrive. Scans wait in a bounded queue until the poses on both sides of their stamp are known.
/// Each scan ends as exactly one onScan or onDrop. A message whose stamp is far from those before
/// it waits for the next one, which confirms it (time jumped) or not (the stamp was wrong: it is
/// dropped). Looks at no clock, so the same messages in the same order always give the same scans.
/// Not thread-safe.
class ScanSynchronizer {
 public:
  /// \param config validated; \param listener must outlive the synchronizer.
  ScanSynchronizer(const NodeConfig& config, ScanListener* listener);

  void add(const PoseMessage& pose);
  void addTf(const tf2_msgs::TFMessage& transforms, bool is_static);
  void add(const sensor_msgs::CameraInfoConstPtr& info);
  /// \param received when the message arrived; matters for expire() only.
  void add(const ScanMessage& scan, const Moment& received = Moment());

  /// Drops scans that arrived more than max_pose_wait ago and still lack something, for when no
  /// newer scans come. Ago by both clocks: a slow replay costs no patience, nor does one that
  /// stalls and then lets simulated time run ahead of messages on their way.
  void expire(const Moment& now);
  /// Drops all scans that wait: no more input will come.
  void finish();
  /// Drops all scans that wait, forgets poses and moving transforms and reports a time jump; for
  /// jumps that the stamps do not show yet.
  void restart(const std::string& why);

  std::size_t waiting() const { return waiting_.size() + (doubtful_scan_ ? 1 : 0); }
  const PoseResolver& poses() const { return poses_; }

 private:
  struct WaitingScan {
    ScanMessage message;
    std::string frame;
    ros::Time stamp;  // time_offset included
    Moment received;
  };
  struct Attempt {
    ResolvedPose pose;
    PinholeIntrinsics intrinsics;
  };

  void add(const WaitingScan& scan);
  void enqueue(const WaitingScan& scan);
  void dropDoubtfulScan();
  void refuseDoubtfulPose();
  void restart(const ros::Time& newest, const ros::Time& stamp, const std::string& what);
  void emitReadyScans();
  void emitFront(const Attempt& result);
  void dropFront(const Drop& drop);
  Attempt attempt(const WaitingScan& waiting) const;
  Drop whyQueueIsFull(const Drop& lacking) const;
  void warn(const std::string& text);

  NodeConfig config_;
  ScanListener* listener_;
  PoseResolver poses_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::deque<WaitingScan> waiting_;
  ros::Time newest_scan_;  // that was not dropped at once
  StampGuard scan_guard_;
  StampGuard pose_guard_;
  std::optional<WaitingScan> doubtful_scan_;
  std::optional<PoseMessage> doubtful_pose_;
  CameraSetupCheck camera_check_;
};

}  // namespace fiimap
