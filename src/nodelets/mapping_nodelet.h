#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include "callback_threads.h"
#include "changes_publisher.h"
#include "cloud_publisher.h"
#include "fiimap/map_handle.h"
#include "fiimap/ros/node_config.h"
#include "input_subscriber.h"
#include "map_services.h"
#include "mapping_diagnostics.h"
#include "mapping_thread.h"
#include "status_publisher.h"
#include "tuning_server.h"
#include "vehicle_publisher.h"

namespace fiimap {

/// The map as a nodelet: topics and services around a MappingThread. Input callbacks only enqueue;
/// the map is made in the mapping thread and published as clouds in the publisher's thread.
class MappingNodelet : public nodelet::Nodelet, private MapObserver {
 public:
  MappingNodelet();
  /// Stops and joins everything; may be called at any moment.
  ~MappingNodelet() override;

 private:
  /// \throws std::invalid_argument on a bad configuration, so that loading fails.
  void onInit() override;
  void configureFromParameters(MapperConfig* mapper_config);
  /// Puts tuned parameters into effect. \return false when the mapping thread is stopping.
  bool retune(const MapperConfig& map, const NodeConfig& node);
  void logStart(const Mapper& mapper);
  void advertise();

  void onDiagnosticsTimer();
  void publishHandle(const Snapshot& snapshot);

  // MapObserver, on the mapping thread.
  void onUpdate(const MapUpdate& update) override;
  void onEdit(const std::shared_ptr<const Snapshot>& snapshot) override;
  void onReset(const std::string& why) override;
  void onDrop(const Drop& drop) override;
  void onWarning(const std::string& text) override;

  NodeConfig node_config_;  // as at the start
  std::shared_ptr<MapHandle> handle_;
  VoxelBox update_box_;  // of the newest scan; of the mapping thread alone
  // Longer than all that is registered with them.
  CallbackThreads input_threads_;
  CallbackThreads service_threads_;
  CallbackThreads diagnostics_threads_;

  // When a drop was warned of, by reason and sensor; of the mapping thread alone.
  std::map<std::pair<DropReason, std::string>, std::chrono::steady_clock::time_point> warned_;

  ros::Publisher statistics_publisher_;
  ros::Publisher handle_publisher_;
  std::unique_ptr<CloudPublisher> clouds_;
  std::unique_ptr<ChangesPublisher> changes_;
  std::unique_ptr<VehiclePublisher> vehicle_;
  std::unique_ptr<StatusPublisher> status_;
  std::unique_ptr<MappingThread> mapping_;
  std::unique_ptr<InputSubscriber> inputs_;
  std::unique_ptr<TuningServer> tuning_;
  std::unique_ptr<MappingDiagnostics> diagnostics_;
  std::unique_ptr<MapServices> services_;
  ros::WallTimer diagnostics_timer_;
  // Of the diagnostics timer alone; a while after the start nothing is missing yet.
  std::chrono::steady_clock::time_point missing_warned_ = std::chrono::steady_clock::now();
};

}  // namespace fiimap
