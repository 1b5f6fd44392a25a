#include "vehicle_watch.h"

#include <cmath>
#include <sstream>

#include "planner_messages.h"

namespace fiimap {

VehicleWatch::VehicleWatch(ros::NodeHandle node, double timeout) : timeout_(timeout) {
  constexpr int kQueue = 10;
  subscriber_ = node.subscribe("odom", kQueue, &VehicleWatch::onOdometry, this);
}

void VehicleWatch::onOdometry(const nav_msgs::Odometry::ConstPtr& message) {
  const double now = ros::Time::now().toSec();
  const std::lock_guard<std::mutex> lock(mutex_);
  // An older message is of no use while newer ones come; later it tells that time jumped back.
  const bool is_older = newest_ && message->header.stamp < newest_->header.stamp;
  if (is_older && std::abs(now - newest_time_) <= timeout_ && now >= newest_time_) return;
  newest_ = message;
  newest_time_ = now;
}

VehicleWatch::View VehicleWatch::look(double time, const std::string& map_frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  View view;
  if (!newest_) {
    view.trouble = "there is no odometry on " + subscriber_.getTopic();
    return view;
  }
  view.state = toVehicleState(*newest_);
  std::ostringstream trouble;
  const std::string& frame = newest_->header.frame_id;
  // Also after a jump back in time: what came before it may be long ago.
  if (std::abs(time - newest_time_) > timeout_) {
    trouble << "there was no odometry for more than " << timeout_ << " s";
  } else if (!isFinite(view.state)) {
    trouble << "the odometry is not finite";
  } else if (!map_frame.empty() && frame != map_frame) {
    trouble << "the odometry is in the frame " << frame << ", the map in " << map_frame;
  }
  view.trouble = trouble.str();
  return view;
}

std::string VehicleWatch::bodyFrame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_ ? newest_->child_frame_id : "";
}

}  // namespace fiimap
