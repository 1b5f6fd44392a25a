#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "fiimap/ros/node_config.h"
#include "mapping_thread.h"

namespace fiimap {

/// Messages of a sensor that arrived.
struct SensorCounts {
  std::atomic<std::uint64_t> scans{0};
  std::atomic<std::uint64_t> camera_infos{0};
};

/// Messages that arrived.
struct InputCounts {
  std::vector<SensorCounts> sensors;
  std::atomic<std::uint64_t> poses{0};  ///< pose messages, or /tf where poses come from there
};

/// Resolved names, for messages to the user.
struct SensorTopics {
  std::string name;  ///< of the sensor; empty where there is one only
  std::string scans;
  std::string camera_infos;  ///< empty where none is needed
};

struct InputTopics {
  std::vector<SensorTopics> sensors;
  std::string poses;
};

/// Subscribes to what the configuration asks for and hands every message to the mapping thread.
/// After its destructor no callback runs any more.
class InputSubscriber {
 public:
  /// \param node whose callbacks run one at a time; \param mapping must outlive this object.
  InputSubscriber(const ros::NodeHandle& node, const NodeConfig& config, MappingThread* mapping);
  ~InputSubscriber();

  const InputCounts& counts() const { return counts_; }
  const InputTopics& topics() const { return topics_; }

 private:
  void subscribeToSensor(const SensorConfig& config, std::size_t sensor);
  void subscribeToPoses(const NodeConfig& config);
  void subscribeToTf(bool gives_poses);
  template <typename Message>
  std::string subscribeToScans(const std::string& topic, std::size_t sensor);
  template <typename Message>
  std::string subscribeToPoseTopic(const std::string& topic);

  ros::NodeHandle node_;
  MappingThread* mapping_;
  InputCounts counts_;
  InputTopics topics_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace fiimap
