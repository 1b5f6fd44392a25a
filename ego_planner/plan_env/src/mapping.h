#pragma once

#include <functional>
#include <memory>
#include <string>

#include <fiimap/ros/map_handle_message.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "ego_parameters.h"
#include "plan_env/grid_map.h"
#include "world_cloud_relay.h"

/// A mapping nodelet inside of this process, and what it needs to hear ego-planner's topics.
class GridMap::Mapping {
 public:
  using OnSnapshot = std::function<void(const std::shared_ptr<const fiimap::Snapshot>&)>;

  /// \param on_snapshot is called by callbacks of `nh`.
  /// \throws std::runtime_error when the nodelet cannot be loaded.
  Mapping(ros::NodeHandle& nh, const EgoParameters& ego, OnSnapshot on_snapshot);
  ~Mapping();

  const EgoParameters& parameters() const { return ego_; }

 private:
  void load(const std::string& name);
  void onMap(const fiimap::MapHandleMessage::ConstPtr& message);
  void onFirstImage(const sensor_msgs::Image::ConstPtr& image);

  EgoParameters ego_;
  OnSnapshot on_snapshot_;
  const std::string topics_;  // what all of ego-planner's begin with, before they are remapped
  nodelet::Loader loader_;
  // Not the planner's queue, which waits while it plans.
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher info_publisher_;
  ros::Subscriber image_subscriber_, map_subscriber_;
  std::unique_ptr<WorldCloudRelay> relay_;
  ros::AsyncSpinner spinner_;
};
