#include "vehicle_publisher.h"

#include <nav_msgs/Path.h>
#include <visualization_msgs/Marker.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

constexpr int kPathQueue = 1;

}  // namespace

VehiclePublisher::VehiclePublisher(ros::NodeHandle node, const std::string& map_frame, double rate)
    : map_frame_(map_frame), thread_(rate, [this] { publish(); }) {
  const auto on_subscriber = [this](const ros::SingleSubscriberPublisher&) { onSubscriber(); };
  path_publisher_ = node.advertise<nav_msgs::Path>("path", kPathQueue, on_subscriber);
  vehicle_publisher_ =
      node.advertise<visualization_msgs::Marker>("vehicle", kPathQueue, on_subscriber);
}

VehiclePublisher::~VehiclePublisher() {
  thread_.stop();
  // Only now, because the thread publishes; subscriber callbacks end here.
  path_publisher_.shutdown();
  vehicle_publisher_.shutdown();
}

void VehiclePublisher::add(const geometry_msgs::PoseStamped& pose) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    path_.add(pose);
  }
  thread_.wake();
}

void VehiclePublisher::clear() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    path_.clear();
  }
  thread_.wake();
}

void VehiclePublisher::onSubscriber() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (path_.poses().empty()) return;
  }
  thread_.wake();
}

void VehiclePublisher::publish() {
  if (path_publisher_.getNumSubscribers() + vehicle_publisher_.getNumSubscribers() == 0) return;
  VehiclePath path;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    path = path_;
  }
  // As shared pointers: nodelets of the same manager get them without a copy.
  if (path_publisher_.getNumSubscribers() > 0) {
    path_publisher_.publish(boost::make_shared<const nav_msgs::Path>(toPath(path, map_frame_)));
  }
  if (vehicle_publisher_.getNumSubscribers() > 0) {
    vehicle_publisher_.publish(
        boost::make_shared<const visualization_msgs::Marker>(toVehicleMarker(path, map_frame_)));
  }
}

}  // namespace fiimap
