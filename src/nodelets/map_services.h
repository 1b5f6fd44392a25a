#pragma once

#include <fiimap/CastRays.h>
#include <fiimap/ClearBox.h>
#include <fiimap/GetBox.h>
#include <fiimap/LoadMap.h>
#include <fiimap/OtherVehicles.h>
#include <fiimap/QueryPoints.h>
#include <fiimap/SaveMap.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <mutex>
#include <vector>

#include "fiimap/map_handle.h"
#include "fiimap/ros/node_config.h"
#include "mapping_thread.h"

namespace fiimap {

/// What others ask of the mapping node: its services, and the topic ~other_vehicles. Queries are
/// answered from the newest snapshot, edits are made between two scans. What is refused is so with
/// the reason in the answer.
class MapServices {
 public:
  /// \param node whose callbacks may wait and may run at once, and have ended before this object
  /// does; \param mapping must outlive this object.
  MapServices(ros::NodeHandle node, const NodeConfig& config,
              std::shared_ptr<const MapHandle> handle, MappingThread* mapping);

 private:
  void onOtherVehicles(const OtherVehiclesConstPtr& message);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onGetBox(GetBox::Request& request, GetBox::Response& response);
  bool onQueryPoints(QueryPoints::Request& request, QueryPoints::Response& response);
  bool onCastRays(CastRays::Request& request, CastRays::Response& response);
  bool onClearBox(ClearBox::Request& request, ClearBox::Response& response);
  bool onSaveMap(SaveMap::Request& request, SaveMap::Response& response);
  bool onLoadMap(LoadMap::Request& request, LoadMap::Response& response);

  /// Writes an answer that a function gives from the newest snapshot.
  template <typename Response, typename Query>
  bool answer(Response* response, const Query& query) const;
  /// Writes an answer that a function gives which edits the map.
  template <typename Response, typename Edit>
  void edit(Response* response, const Edit& edit) const;

  NodeConfig config_;
  std::shared_ptr<const MapHandle> handle_;
  MappingThread* mapping_;
  std::mutex files_mutex_;
  std::vector<ros::ServiceServer> servers_;
  ros::Subscriber other_vehicles_;
};

}  // namespace fiimap
