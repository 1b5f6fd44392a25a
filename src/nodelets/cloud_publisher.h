#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "fiimap/snapshot.h"
#include "publishing_thread.h"

namespace fiimap {

/// Publishes the clouds and outlines of the newest snapshot in its own thread, only for topics with
/// subscribers and at most at a given rate; a new subscriber gets the newest map at once.
/// Thread-safe.
class CloudPublisher {
 public:
  /// \param node where the topics are advertised; \param rate Hz.
  CloudPublisher(ros::NodeHandle node, const std::string& map_frame, double rate);
  ~CloudPublisher();

  /// \param update_box voxels that the newest scan could change.
  void offer(std::shared_ptr<const Snapshot> snapshot, const VoxelBox& update_box);
  /// Publishes empty clouds: the map was forgotten.
  void clear();
  void setRate(double rate) { thread_.setRate(rate); }

 private:
  void onSubscriber();
  void publish();
  void publish(const Snapshot& snapshot, const VoxelBox& update_box);
  void publishCloud(const ros::Publisher& publisher, const Snapshot& snapshot, Plane plane) const;
  void publishEmpty() const;

  std::string map_frame_;
  std::mutex mutex_;
  std::shared_ptr<const Snapshot> snapshot_;
  VoxelBox update_box_;

  ros::Publisher occupied_;
  ros::Publisher inflated_;
  ros::Publisher window_;
  PublishingThread thread_;  // last, because it uses the others
};

}  // namespace fiimap
