#pragma once

#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "fiimap/ros/vehicle_path.h"
#include "publishing_thread.h"

namespace fiimap {

/// Publishes the path of the vehicle and a marker where it is, only for topics with subscribers and
/// at most at a given rate; a new subscriber gets the newest at once. Thread-safe.
class VehiclePublisher {
 public:
  /// \param node where the topics are advertised; \param rate Hz.
  VehiclePublisher(ros::NodeHandle node, const std::string& map_frame, double rate);
  ~VehiclePublisher();

  /// \param pose of the vehicle's body in the map frame.
  void add(const geometry_msgs::PoseStamped& pose);
  /// Forgets the path and takes the marker away.
  void clear();
  void setRate(double rate) { thread_.setRate(rate); }

 private:
  void onSubscriber();
  void publish();

  std::string map_frame_;
  std::mutex mutex_;
  VehiclePath path_;
  ros::Publisher path_publisher_;
  ros::Publisher vehicle_publisher_;
  PublishingThread thread_;  // last, because it uses the others
};

}  // namespace fiimap
