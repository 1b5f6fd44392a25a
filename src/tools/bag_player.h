#pragma once

#include <rosbag/bag.h>

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
  const rosbag::Bag* bag_;
  BagTopics topics_;
  NodeConfig config_;
};

}  // namespace fiimap
