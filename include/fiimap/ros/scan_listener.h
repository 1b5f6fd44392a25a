#pragma once

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <variant>

#include "fiimap/depth_projector.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/drop_reason.h"

namespace fiimap {

/// A scan as it arrives.
using ScanMessage = std::variant<sensor_msgs::ImageConstPtr, sensor_msgs::PointCloud2ConstPtr>;

/// A moment by two clocks.
struct Moment {
  ros::Time ros;                                 ///< simulated time in a replay
  std::chrono::steady_clock::time_point steady;  ///< real time
};

/// A scan with all that is needed to integrate it.
struct SynchronizedScan {
  std::size_t sensor = 0;                                   ///< index in NodeConfig::sensors
  ScanMessage message;                                      ///< as it arrived
  PinholeIntrinsics intrinsics;                             ///< of images only
  ScanPose pose;                                            ///< interpolated at its stamp
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();  ///< vehicle's body to world
  double pose_gap = 0.0;                                    ///< s between the poses around the scan
};

/// Receives what a ScanSynchronizer finds, from within the call that caused it.
class ScanListener {
 public:
  virtual ~ScanListener() = default;

  /// A scan that has all that it needs.
  virtual void onScan(const SynchronizedScan& scan) = 0;
  /// A scan that will never be in the map.
  /// \param sensor that the scan is from: index in NodeConfig::sensors.
  virtual void onDrop(const Drop& drop, std::size_t sensor) = 0;
  /// Stamps went back (a bag began again): what was mapped before must be forgotten.
  virtual void onTimeJump(const std::string& what) = 0;
  /// Something that a user should know, once each.
  virtual void onWarning(const std::string& text) = 0;
};

}  // namespace fiimap
