#pragma once

#include <rosbag/view.h>

#include <string>
#include <vector>

#include "fiimap/parameters.h"
#include "fiimap/ros/node_config.h"

namespace fiimap {

/// Which topics of a bag are the map's inputs. Empty: found by their type.
struct BagTopics {
  std::string depth_topic;
  std::string camera_info_topic;
  std::string points_topic;
  std::string pose_topic;

  std::vector<Parameter> parameters();
};

/// Fills in what the user left open, from the message types in the bag: topics, and, where
/// `settings` does not name them, config->sensor (a depth image with intrinsics before a cloud;
/// what is a depth image, its encoding tells), config->pose_source (odometry, then pose, then
/// transform, then TF) and config->map_frame (the frame of the first pose). \throws
/// std::invalid_argument when there is no input, or more than one candidate for it; the text lists
/// them.
BagTopics chooseTopics(const rosbag::Bag& bag, const ParameterMap& settings, BagTopics topics,
                       NodeConfig* config);

}  // namespace fiimap
