#pragma once

// ego-planner's packages include this header in C++11 and C++14: nothing newer, and no header of
// fiimap. What they use of other headers and of std they get through it.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <queue>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <Eigen/Eigen>

using namespace std;  // NOLINT: they say vector, string and unique_ptr

namespace fiimap {
class Snapshot;
}

/// The map as ego-planner's packages call it. A fiimap/MappingNodelet makes it in threads of its
/// own inside of the planner's process; callbacks of the planner's thread only take its newest
/// snapshot, so that a plan sees one map from its beginning to its end. Not thread-safe: to be
/// called from the thread that spins the node handle's callbacks.
class GridMap {
 public:
  typedef std::shared_ptr<GridMap> Ptr;

  GridMap();
  ~GridMap();
  GridMap(const GridMap&) = delete;
  GridMap& operator=(const GridMap&) = delete;

  /// Reads the parameters ~grid_map/... and starts the map.
  /// \param nh the planner's private node handle.
  /// \throws std::runtime_error when the map cannot be started; the reason was logged.
  void initMap(ros::NodeHandle& nh);

  /// Edge length of a voxel, metres.
  double getResolution() { return resolution_; }

  /// 1: inflated; 0: free or unknown; outside of the map -1, or 0 with the parameters of version 2.
  /// Takes no lock.
  /// \param position metres, map frame.
  int getInflateOccupancy(Eigen::Vector3d position);
  /// The same for what was measured: 1 where an obstacle is.
  int getOccupancy(Eigen::Vector3d position);

  /// Whether scans came and then none for ~grid_map/odom_depth_timeout seconds: the planner should
  /// stop.
  bool getOdomDepthTimeout();

 private:
  class Mapping;  // what runs the map; keeps its headers out of here

  int withoutSnapshot(const Eigen::Vector3d& position) const;
  int outside(const Eigen::Vector3d& position) const;

  double resolution_ = 0.0;
  double timeout_ = 0.0;  // s
  std::shared_ptr<const fiimap::Snapshot> snapshot_;
  std::unique_ptr<Mapping> mapping_;
};
