#pragma once

#include <mutex>
#include <string>

#include <ros/ros.h>

#include "flown_trajectory.h"
#include "heading_control.h"
#include "periodic_thread.h"

namespace fiimap {

/// Publishes where the vehicle shall be now, on the topic command, in a thread of its own, so that
/// nothing that takes time delays it. Thread-safe.
class CommandThread {
 public:
  /// \param rate Hz; \param max_yaw_rate rad/s.
  CommandThread(ros::NodeHandle node, double rate, double max_yaw_rate);
  ~CommandThread();

  /// What to fly from now on; without a current trajectory no commands are published.
  /// \param yaw of the vehicle, rad: from where it turns when it begins.
  void fly(const FlownTrajectory& flown, double yaw, const std::string& map_frame,
           const std::string& body_frame);

 private:
  void publish();

  std::mutex mutex_;
  FlownTrajectory flown_;
  HeadingControl heading_;
  std::string map_frame_, body_frame_;
  double last_time_ = 0.0;  ///< s
  ros::Publisher publisher_;
  PeriodicThread thread_;  ///< last: it uses the others
};

}  // namespace fiimap
