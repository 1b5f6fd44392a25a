#include "waiting_clock.h"

#include <algorithm>

#include "fiimap/ros/stamps.h"

namespace fiimap {

WaitingClock::Reading WaitingClock::read() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::Time ros = ros::Time::now();
  const auto steady = std::chrono::steady_clock::now();
  const double ros_step = secondsBetween(ros_, ros);
  const double steady_step = std::chrono::duration<double>(steady - steady_).count();
  ros_ = ros;
  steady_ = steady;
  waiting_ += ros::Duration(std::max(0.0, std::min(ros_step, steady_step)));
  return {waiting_, std::max(0.0, -ros_step)};
}

}  // namespace fiimap
