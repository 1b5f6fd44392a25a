#include "world_cloud_relay.h"

#include <cmath>

#include <sensor_msgs/point_cloud2_iterator.h>
#include <boost/make_shared.hpp>

namespace {

constexpr int kRelayQueue = 10;

}  // namespace

WorldCloudRelay::WorldCloudRelay(ros::NodeHandle node, const Topics& topics)
    : cloud_publisher_(
          node.advertise<sensor_msgs::PointCloud2>(topics.relative_cloud, kRelayQueue)),
      pose_publisher_(
          node.advertise<geometry_msgs::PoseStamped>(topics.relative_pose, kRelayQueue)) {
  odom_subscriber_ = node.subscribe(topics.odom, kRelayQueue, &WorldCloudRelay::onOdometry, this);
  pose_subscriber_ = node.subscribe(topics.pose, kRelayQueue, &WorldCloudRelay::onPose, this);
  cloud_subscriber_ = node.subscribe(topics.cloud, kRelayQueue, &WorldCloudRelay::onCloud, this);
}

WorldCloudRelay::~WorldCloudRelay() {
  for (ros::Subscriber* s : {&odom_subscriber_, &pose_subscriber_, &cloud_subscriber_}) {
    s->shutdown();
  }
}

void WorldCloudRelay::onOdometry(const nav_msgs::Odometry::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  position_ = message->pose.pose.position;
  has_position_ = true;
}

void WorldCloudRelay::onPose(const geometry_msgs::PoseStamped::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  position_ = message->pose.position;
  has_position_ = true;
}

void WorldCloudRelay::onCloud(const sensor_msgs::PointCloud2::ConstPtr& message) {
  const auto pose = boost::make_shared<geometry_msgs::PoseStamped>();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!has_position_) return;
    pose->pose.position = position_;
  }
  pose->header = message->header;
  pose->pose.orientation.w = 1.0;
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*message);
  const geometry_msgs::Point& p = pose->pose.position;
  if (!cloud->data.empty()) {  // the iterator asks for the first byte
    for (sensor_msgs::PointCloud2Iterator<float> xyz(*cloud, "x"); xyz != xyz.end(); ++xyz) {
      xyz[0] -= static_cast<float>(p.x);
      xyz[1] -= static_cast<float>(p.y);
      xyz[2] -= static_cast<float>(p.z);
    }
  }
  pose_publisher_.publish(geometry_msgs::PoseStamped::ConstPtr(pose));
  cloud_publisher_.publish(sensor_msgs::PointCloud2::ConstPtr(cloud));
}
