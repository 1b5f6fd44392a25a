#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "mapping_thread.h"
#include "publishing_thread.h"

namespace fiimap {

/// Publishes the markers of the newest update (status_markers.h) in its own thread, only while
/// somebody subscribes and at most at a given rate; a new subscriber gets the newest at once.
/// Thread-safe.
class StatusPublisher {
 public:
  /// \param node where the topic is advertised; \param rate Hz.
  StatusPublisher(ros::NodeHandle node, const std::string& map_frame, double rate);
  ~StatusPublisher();

  void setRate(double rate) { thread_.setRate(rate); }

  void offer(const MapUpdate& update);
  /// Takes the markers away: the map was forgotten.
  void clear();

 private:
  void onSubscriber();
  void publish();

  std::string map_frame_;
  std::mutex mutex_;
  std::optional<MapUpdate> update_;

  std::shared_ptr<const Snapshot> shown_;  // last; of the publishing thread alone
  ros::Publisher publisher_;
  PublishingThread thread_;  // last, because it uses the others
};

}  // namespace fiimap
