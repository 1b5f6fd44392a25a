#pragma once

#include <mutex>
#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>

#include "flight.h"

namespace fiimap {

/// The vehicle's state by its odometry. Thread-safe.
class VehicleWatch {
 public:
  struct View {
    VehicleState state;
    std::string trouble;  ///< why the state cannot be trusted; empty: it can
  };

  /// \param timeout s without odometry after which the state is not trusted any more.
  VehicleWatch(ros::NodeHandle node, double timeout);
  /// No callback is running any more when it is gone.
  ~VehicleWatch() { subscriber_.shutdown(); }

  /// \param time now, s; \param map_frame empty: not known yet.
  View look(double time, const std::string& map_frame) const;
  /// Frame of the vehicle's body.
  std::string bodyFrame() const;

 private:
  void onOdometry(const nav_msgs::Odometry::ConstPtr& message);

  double timeout_;
  mutable std::mutex mutex_;
  nav_msgs::Odometry::ConstPtr newest_;
  double newest_time_ = 0.0;    ///< when it came, s
  ros::Subscriber subscriber_;  ///< last: its callbacks use the others
};

}  // namespace fiimap
