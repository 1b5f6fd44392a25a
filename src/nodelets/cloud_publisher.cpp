#include "cloud_publisher.h"

#include <utility>

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

constexpr int kCloudQueue = 1;
constexpr int kMarkerQueue = 2;  // window and update range

}  // namespace

CloudPublisher::CloudPublisher(ros::NodeHandle node, const std::string& map_frame, double rate)
    : map_frame_(map_frame), thread_(rate, [this] { publish(); }) {
  const auto on_subscriber = [this](const ros::SingleSubscriberPublisher&) { onSubscriber(); };
  occupied_ = node.advertise<sensor_msgs::PointCloud2>("occupied", kCloudQueue, on_subscriber);
  inflated_ = node.advertise<sensor_msgs::PointCloud2>("inflated", kCloudQueue, on_subscriber);
  window_ = node.advertise<visualization_msgs::Marker>("window", kMarkerQueue, on_subscriber);
}

CloudPublisher::~CloudPublisher() {
  thread_.stop();
  // Only now, because the thread publishes; subscriber callbacks end here.
  for (ros::Publisher* publisher : {&occupied_, &inflated_, &window_}) publisher->shutdown();
}

void CloudPublisher::offer(std::shared_ptr<const Snapshot> snapshot, const VoxelBox& update_box) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    snapshot_ = std::move(snapshot);
    update_box_ = update_box;
  }
  thread_.wake();
}

void CloudPublisher::clear() { offer(nullptr, VoxelBox()); }

void CloudPublisher::onSubscriber() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!snapshot_) return;
  }
  thread_.wake();
}

void CloudPublisher::publish() {
  std::shared_ptr<const Snapshot> snapshot;
  VoxelBox update_box;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    snapshot = snapshot_;
    update_box = update_box_;
  }
  if (snapshot) {
    publish(*snapshot, update_box);
  } else {
    publishEmpty();
  }
}

void CloudPublisher::publish(const Snapshot& snapshot, const VoxelBox& update_box) {
  publishCloud(occupied_, snapshot, Plane::kOccupied);
  publishCloud(inflated_, snapshot, Plane::kInflated);
  if (window_.getNumSubscribers() == 0) return;
  window_.publish(toOutline(snapshot.window(), snapshot, map_frame_, "window"));
  window_.publish(toOutline(update_box, snapshot, map_frame_, "update_range"));
}

void CloudPublisher::publishCloud(const ros::Publisher& publisher, const Snapshot& snapshot,
                                  Plane plane) const {
  if (publisher.getNumSubscribers() == 0) return;
  // As a shared pointer: nodelets of the same manager get it without a copy.
  publisher.publish(boost::make_shared<const sensor_msgs::PointCloud2>(
      toPointCloud(snapshot, plane, map_frame_)));
}

void CloudPublisher::publishEmpty() const {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = map_frame_;
  const auto cloud = boost::make_shared<const sensor_msgs::PointCloud2>(emptyCloud(header));
  for (const ros::Publisher* publisher : {&occupied_, &inflated_}) {
    if (publisher->getNumSubscribers() > 0) publisher->publish(cloud);
  }
}

}  // namespace fiimap
