#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "fiimap/ros/node_config.h"
#include "fiimap/ros/pose_resolver.h"
#include "fiimap/ros/scan_listener.h"
#include "fiimap/ros/sensor_input.h"
#include "fiimap/ros/stamp_guard.h"

namespace fiimap {

/// A pose as it arrives.
using PoseMessage =
    std::variant<nav_msgs::Odometry, geometry_msgs::PoseStamped, geometry_msgs::TransformStamped>;

/// Brings scans, poses, transforms and intrinsics together by their stamps, in whatever order they
/// arrive. The scans of each sensor wait in a bounded queue of their own, so that none holds up
/// another, until the poses on both sides of their stamp are known; of those that are ready at
/// once, the oldest goes first. Each scan ends as exactly one onScan or onDrop. A message whose
/// stamp is far from those before it on its topic waits for the next one, which confirms it (time
/// jumped) or not (the stamp was wrong: it is dropped). Looks at no clock, so the same messages in
/// the same order always give the same scans. Not thread-safe.
class ScanSynchronizer {
 public:
  /// \param config validated; \param listener must outlive the synchronizer.
  ScanSynchronizer(const NodeConfig& config, ScanListener* listener);

  /// Goes on with other time offsets, max_pose_gap and max_pose_wait.
  /// \param config validated; differs in what is `tunable` only.
  void reconfigure(const NodeConfig& config);

  /// Takes a pose of the body, which may complete scans.
  void add(const PoseMessage& pose);
  /// Takes what came on /tf, or on /tf_static.
  void addTf(const tf2_msgs::TFMessage& transforms, bool is_static);
  /// Takes the intrinsics of a depth camera.
  /// \param sensor index in NodeConfig::sensors.
  void add(const sensor_msgs::CameraInfoConstPtr& info, std::size_t sensor = 0);
  /// Takes a scan.
  /// \param received when the message arrived; matters for expire() only.
  void add(const ScanMessage& scan, const Moment& received = Moment(), std::size_t sensor = 0);

  /// Drops scans that arrived more than max_pose_wait ago and still lack something, for when no
  /// newer scans come. Ago by both clocks: a slow replay costs no patience, nor does one that
  /// stalls and then lets simulated time run ahead of messages on their way.
  void expire(const Moment& now);
  /// Drops all scans that wait: no more input will come.
  void finish();
  /// Drops all scans that wait, forgets poses and moving transforms and reports a time jump; for
  /// jumps that the stamps do not show yet.
  void restart(const std::string& why);

  /// Scans of a sensor that wait.
  std::size_t waiting(std::size_t sensor = 0) const { return sensors_.at(sensor).waiting(); }
  /// The poses and transforms that are kept.
  const PoseResolver& poses() const { return poses_; }

 private:
  void add(const SensorInput::Scan& scan, SensorInput* sensor);
  void refuseDoubtfulPose();
  void restart(const ros::Time& newest, const ros::Time& stamp, const std::string& what);
  void emitReadyScans();
  ros::Time newestScan(const SensorInput* without = nullptr) const;
  bool isFarAhead(const SensorInput& sensor) const;

  ScanListener* listener_;
  std::string map_frame_;
  PoseResolver poses_;
  std::deque<SensorInput> sensors_;
  StampGuard pose_guard_;
  std::optional<PoseMessage> doubtful_pose_;
};

}  // namespace fiimap
