#pragma once

#include <rosbag/bag.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bag_topics.h"
#include "fiimap/mapper_config.h"
#include "fiimap/parameters.h"
#include "fiimap/ros/node_config.h"

namespace fiimap {

/// What every command on a recording is told.
struct InputOptions {
  std::string bag;
  std::string config;                 ///< YAML file; empty: defaults
  std::vector<std::string> settings;  ///< "name=value", after the file
  std::string json;                   ///< where to write the figures; empty: nowhere
};

/// A recording that is open, with the configuration that the nodelet would have for it.
/// \throws std::exception with a message for the user when input or settings are bad.
class EvaluationInput {
 public:
  explicit EvaluationInput(const InputOptions& options);

  const rosbag::Bag& bag() const { return bag_; }
  const MapperConfig& mapper() const { return mapper_; }
  const NodeConfig& node() const { return node_; }
  const BagTopics& topics() const { return topics_; }

  /// For what compares with maps or scans of one sensor.
  /// \throws std::invalid_argument when there are several.
  void requireOneSensor() const;

  /// Writes figures, completed by the bag's name and all parameters, where --json says.
  void writeJson(nlohmann::json figures) const;

 private:
  ParameterMap readSettings();

  InputOptions options_;
  rosbag::Bag bag_;
  MapperConfig mapper_;
  NodeConfig node_;
  BagTopics topics_;
};

}  // namespace fiimap
