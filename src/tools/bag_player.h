#pragma once

#include <rosbag/bag.h>

#include <string>
#include <vector>

#include "bag_topics.h"
#include "fiimap/ros/scan_counters.h"
#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap {

/// Feeds the messages of a bag, in the order in which they were recorded, to a synchroniser as the
/// nodelet's callbacks do, as fast as it takes them. Deterministic.
class BagPlayer {
 public:
  BagPlayer(const rosbag::Bag& bag, const BagTopics& topics, const NodeConfig& config);

  /// Scans in the bag.
  std::size_t scans() const;
  /// Plays the whole bag; scans, drops and warnings go to `listener`.
  /// \param counters its `received` counts the scans as they are read.
  void play(ScanListener* listener, ScanCounters* counters);

 private:
  void addInfo(const sensor_msgs::CameraInfoConstPtr& info, const std::string& topic,
               ScanSynchronizer* synchronizer) const;

  const rosbag::Bag* bag_;
  NodeConfig config_;
  std::string pose_topic_;
  std::vector<std::string> scan_topics_;  // by sensor
  std::vector<std::string> info_topics_;  // by sensor; empty where none are needed
};

}  // namespace fiimap
