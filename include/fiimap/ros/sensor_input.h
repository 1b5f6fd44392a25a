#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "fiimap/ros/camera_setup_check.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/pose_resolver.h"
#include "fiimap/ros/scan_listener.h"
#include "fiimap/ros/stamp_guard.h"

namespace fiimap {

/// The scans of one sensor on their way to the map: guards their stamps and lets them wait for what
/// they lack. What it drops it tells the listener, and nothing else. Not thread-safe.
class SensorInput {
 public:
  /// A scan that waits.
  struct Scan {
    ScanMessage message;  ///< as it arrived
    std::string frame;    ///< of the sensor
    ros::Time stamp;      ///< time_offset included
    Moment received;      ///< when it arrived
  };
  /// What a scan needs to be integrated, or why it is not known.
  struct Match {
    ResolvedPose pose;             ///< of the sensor at its stamp
    PinholeIntrinsics intrinsics;  ///< of images only
  };

  /// \param index in NodeConfig::sensors; \param poses, listener must outlive this object.
  SensorInput(const NodeConfig& config, std::size_t index, const PoseResolver* poses,
              ScanListener* listener);

  /// Goes on with another time_offset, which does not touch scans that wait, and max_pose_wait.
  /// \param config differs in what is `tunable` only.
  void reconfigure(const NodeConfig& config);

  /// Of this sensor.
  const SensorConfig& config() const { return config_; }
  /// Newest stamp that was not dropped at once; zero when there is none.
  const ros::Time& newest() const { return newest_; }
  /// Newest good stamp, of scans that were dropped too.
  const ros::Time& newestGood() const { return guard_.newest(); }
  /// Stamp of the first scan that waits; there must be one.
  const ros::Time& front() const { return waiting_.front().stamp; }
  /// Scans that wait.
  std::size_t waiting() const { return waiting_.size() + (doubtful_ ? 1 : 0); }

  /// The intrinsics from now on.
  void add(const sensor_msgs::CameraInfoConstPtr& info);
  /// \return the message with its stamp; nothing when it was dropped because it has none.
  std::optional<Scan> stamped(const ScanMessage& message, const Moment& received);
  /// Adds a scan to those that wait.
  /// \param others newest good stamp of the other sensors; zero when there is none.
  /// \return false when its stamp tells that time began again: it is to be added again after
  /// restart().
  bool add(const Scan& scan, const ros::Time& others);

  /// Drops scans that will never have what they need.
  /// \return what the first of the others needs, when it is known.
  std::optional<Match> matchFront();
  /// Takes the first scan out of the queue, with what matchFront() found.
  SynchronizedScan takeFront(const Match& match);
  /// Drops the first scan when more than scan_queue_size wait. \return whether it did.
  bool dropExcess();
  /// Drops the first scan when it waits too long by both clocks. \return whether it did.
  bool expireFront(const Moment& now);
  /// Drops all scans that wait.
  void finish();
  /// Drops all scans that wait and begins anew. \return the one that belongs to the new time.
  std::optional<Scan> restart(const std::string& why);

 private:
  void enqueue(const Scan& scan);
  void drop(const Drop& drop) const;
  void dropDoubtful();
  void dropFront(const Drop& drop);
  Match match(const Scan& scan) const;
  Drop whyQueueIsFull(const Drop& lacking) const;
  void warn(const std::string& text) const;
  bool waitsLong(const Scan& scan, const Moment& now) const;

  SensorConfig config_;
  double max_pose_wait_;  // s
  std::size_t queue_size_;
  std::size_t index_;
  const PoseResolver* poses_;
  ScanListener* listener_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::deque<Scan> waiting_;
  ros::Time newest_;
  StampGuard guard_;
  std::optional<Scan> doubtful_;
  CameraSetupCheck camera_check_;
};

}  // namespace fiimap
