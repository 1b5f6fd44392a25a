#pragma once

#include <mutex>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

/// Clouds in the map frame do not say where their rays began. This gives them the position of the
/// newest odometry: publishes each cloud relative to it, with a pose of its stamp. Its callbacks
/// run in the threads of the queue of its node handle.
class WorldCloudRelay {
 public:
  /// \param input topics cloud and odom (or pose); \param output topics points and pose.
  struct Topics {
    std::string cloud, odom, pose, relative_cloud, relative_pose;
  };

  WorldCloudRelay(ros::NodeHandle node, const Topics& topics);
  ~WorldCloudRelay();

 private:
  void onOdometry(const nav_msgs::Odometry::ConstPtr& message);
  void onPose(const geometry_msgs::PoseStamped::ConstPtr& message);
  void onCloud(const sensor_msgs::PointCloud2::ConstPtr& message);

  std::mutex mutex_;
  bool has_position_ = false;
  geometry_msgs::Point position_;
  ros::Publisher cloud_publisher_, pose_publisher_;
  ros::Subscriber odom_subscriber_, pose_subscriber_, cloud_subscriber_;
};
