#pragma once

#include <memory>
#include <mutex>

#include <fiimap/MapChanges.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include "fiimap/ros/map_changes_reader.h"

namespace fiimap {

/// The far end of ~changes: subscribes to `changes` and publishes the clouds and the window of the
/// mapping node again. Subscribes only while somebody subscribes to it, so that nothing is sent in
/// vain over the link between.
class RebuildCloudsNodelet : public nodelet::Nodelet {
 public:
  RebuildCloudsNodelet() = default;
  /// Stops everything; may be called at any moment.
  ~RebuildCloudsNodelet() override;

 private:
  /// \throws std::invalid_argument on a bad parameter, so that loading fails.
  void onInit() override;
  void onSubscribers();
  void onChanges(const MapChangesConstPtr& message);
  void publishMap() const;
  void publishCloud(const ros::Publisher& publisher, Plane plane) const;
  void onMissingTimer();

  double memory_limit_ = 0.0;  // MB

  mutable std::mutex mutex_;  // of all below
  std::unique_ptr<MapChangesReader> reader_;
  MapChangesConstPtr shown_;                  // the newest message that could be applied
  std::shared_ptr<const Snapshot> snapshot_;  // of that message; null: there was no map

  ros::Publisher occupied_;
  ros::Publisher inflated_;
  ros::Publisher window_;
  ros::Subscriber changes_;
  ros::WallTimer missing_timer_;
};

}  // namespace fiimap
