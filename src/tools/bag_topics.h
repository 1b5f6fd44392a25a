#pragma once

#include <rosbag/view.h>

#include <string>
#include <vector>

#include "fiimap/parameters.h"
#include "fiimap/ros/node_config.h"

namespace fiimap {

/// Which topics of a bag are a sensor's. Empty: found by their type.
struct SensorBagTopics {
  std::string depth_topic;
  std::string camera_info_topic;
  std::string points_topic;

  /// Where its scans are.
  const std::string& scans(SensorKind kind) const {
    return kind == SensorKind::kDepth ? depth_topic : points_topic;
  }
};

/// Which topics of a bag are the map's inputs. Empty: found by their type.
struct BagTopics {
  std::vector<SensorBagTopics> sensors;  ///< in the order of NodeConfig::allSensors()
  std::string pose_topic;

  /// Those of sensors that have names begin with them: "front/depth_topic". Adds what `sensors`
  /// lacks.
  std::vector<Parameter> parameters(const NodeConfig& config);
};

/// Fills in what the user left open, from the message types in the bag: topics, and, where
/// `settings` does not name them, config->sensor of a single sensor (a depth image with intrinsics
/// before a cloud; what is a depth image, its encoding tells), config->pose_source (odometry, then
/// pose, then transform, then TF) and config->map_frame (the frame of the first pose). Of several
/// topics of a type, a sensor's own is the one that the node would subscribe to.
/// \throws std::invalid_argument when there is no input, or more than one candidate for it (the
/// text lists them), or when a topic holds messages of another type.
BagTopics chooseTopics(const rosbag::Bag& bag, const ParameterMap& settings, BagTopics topics,
                       NodeConfig* config);

}  // namespace fiimap
