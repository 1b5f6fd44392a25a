#pragma once

#include <chrono>
#include <mutex>

#include <ros/time.h>

namespace fiimap {

/// Measures how long something has waited: advances only as far as both the ROS clock and the
/// steady clock do. So a paused or slow replay costs no patience, nor does a replay that stalls and
/// then lets the ROS clock run ahead of messages that are still on their way. Thread-safe.
class WaitingClock {
 public:
  struct Reading {
    ros::Time time;          ///< to be compared with other readings only
    double step_back = 0.0;  ///< s by which the ROS clock went back since the last reading
  };

  Reading read();

 private:
  std::mutex mutex_;
  ros::Time ros_ = ros::Time::now();
  std::chrono::steady_clock::time_point steady_ = std::chrono::steady_clock::now();
  ros::Time waiting_ = ros::TIME_MIN;
};

}  // namespace fiimap
