#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "diagnostic_summary.h"
#include "mapping_thread.h"

namespace fiimap {

/// Which inputs a map has.
enum class RigInputs {
  kDepth,   ///< images, odometry, extrinsics from /tf_static
  kPoints,  ///< clouds, odometry, extrinsics from parameters
  kTf,      ///< images, poses and extrinsics from TF
};

/// What comes in for one scan, in the order in which it is sent; to be spoiled.
struct Frame {
  std::vector<nav_msgs::Odometry> poses;
  std::vector<geometry_msgs::TransformStamped> transforms;
  std::optional<sensor_msgs::CameraInfo> info;
  std::optional<sensor_msgs::Image> image;
  std::optional<sensor_msgs::PointCloud2> cloud;
};

/// What is known of a map and its inputs at one moment.
struct RigState {
  InputTotals totals;
  std::uint64_t sent = 0;  ///< scans
  std::shared_ptr<const Snapshot> snapshot;
  std::optional<MapUpdate> update;
};

/// The mapping thread of the nodelet, fed with messages of a still vehicle in front of a wall. ROS
/// time is simulated and stands still, but for settle(), so that a slow machine changes nothing.
class FaultRig : private MapObserver {
 public:
  static constexpr int kWidth = 32, kHeight = 24;  // pixels
  static constexpr double kPeriod = 0.1;           // s between scans
  static constexpr double kWall = 2.0;             // m

  /// \param clock where the simulated clock begins, s.
  FaultRig(RigInputs inputs, double clock);
  ~FaultRig() override;

  /// What the map and its inputs are configured to at the start.
  static MapperConfig mapperConfig();
  static NodeConfig nodeConfig(RigInputs inputs);

  /// A good frame of the next moment.
  Frame next();
  void send(Frame frame);
  void sendPose(const nav_msgs::Odometry& pose);
  void sendTransform(const geometry_msgs::TransformStamped& transform, bool is_static = false);
  /// Sends good frames.
  void fly(int frames);
  /// Waits until no scan is on its way; lets time pass for those that wait.
  void settle();
  /// Waits until the mapping thread has looked at all scans; they may still wait for their poses.
  void waitUntilReceived() const;

  nav_msgs::Odometry poseAt(double seconds) const;
  geometry_msgs::TransformStamped transformAt(double seconds) const;
  ros::Time stampAt(double seconds) const;

  /// Moment of the newest frame, s; the next one follows a period later.
  double now() const { return now_; }
  void setNow(double seconds) { now_ = seconds; }
  /// Moves the simulated clock, which is not bound to the stamps. From then on it stands still, in
  /// settle() too.
  void moveClock(double seconds);
  /// Keeps the mapping thread busy with the next scan until release().
  void block();
  void waitUntilBlocked();
  void release();

  MappingThread& mapping() { return *mapping_; }
  RigState state() const;
  /// Good frames that were flown.
  std::uint64_t flown() const { return flown_; }
  const InputTopics& topics() const { return topics_; }
  /// All that a user would read on the console, since the last call.
  std::vector<std::string> takeTexts();

 private:
  void onUpdate(const MapUpdate& update) override;
  void onReset(const std::string& why) override;
  void onDrop(const Drop& drop) override;
  void onWarning(const std::string& text) override;
  void addText(const std::string& text);

  RigInputs inputs_;
  InputTopics topics_;
  std::shared_ptr<MapHandle> handle_;
  std::uint64_t sent_ = 0, infos_ = 0, poses_ = 0, flown_ = 0;
  double now_ = 1000.0;
  double clock_;
  bool clock_is_given_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool block_ = false, blocked_ = false;
  std::vector<std::string> texts_;
  std::optional<MapUpdate> update_;

  std::unique_ptr<MappingThread> mapping_;
};

}  // namespace fiimap
