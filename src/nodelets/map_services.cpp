#include "map_services.h"

#include <stdexcept>
#include <utility>

#include "fiimap/ros/map_edits.h"
#include "fiimap/ros/map_files.h"
#include "fiimap/ros/map_queries.h"
#include "fiimap/ros/other_vehicles.h"

namespace fiimap {
namespace {

const char* const kShuttingDown = "the node is shutting down";
constexpr int kVehicleQueue = 100;
constexpr double kWarningPeriod = 5.0;  // s

/// Lets a function fill an answer, which says why when it throws.
template <typename Response, typename Fill>
bool fillOrRefuse(Response* response, Fill&& fill) {
  try {
    fill();
  } catch (const std::exception& error) {
    *response = Response();
    response->message = error.what();
  }
  return true;
}

}  // namespace

MapServices::MapServices(ros::NodeHandle node, const NodeConfig& config,
                         std::shared_ptr<const MapHandle> handle, MappingThread* mapping)
    : config_(config), handle_(std::move(handle)), mapping_(mapping) {
  servers_.push_back(node.advertiseService("reset", &MapServices::onReset, this));
  servers_.push_back(node.advertiseService("get_box", &MapServices::onGetBox, this));
  servers_.push_back(node.advertiseService("query_points", &MapServices::onQueryPoints, this));
  servers_.push_back(node.advertiseService("cast_rays", &MapServices::onCastRays, this));
  servers_.push_back(node.advertiseService("clear_box", &MapServices::onClearBox, this));
  servers_.push_back(node.advertiseService("save_map", &MapServices::onSaveMap, this));
  servers_.push_back(node.advertiseService("load_map", &MapServices::onLoadMap, this));
  other_vehicles_ =
      node.subscribe("other_vehicles", kVehicleQueue, &MapServices::onOtherVehicles, this);
}

template <typename Response, typename Query>
bool MapServices::answer(Response* response, const Query& query) const {
  return fillOrRefuse(response, [&] {
    const std::shared_ptr<const Snapshot> snapshot = handle_->latest();
    if (!snapshot) throw std::runtime_error("there is no map yet");
    *response = query(*snapshot);
  });
}

template <typename Response, typename Edit>
void MapServices::edit(Response* response, const Edit& edit) const {
  const bool is_done = mapping_->edit([&](Mapper* mapper) { *response = edit(mapper); });
  if (!is_done) throw std::runtime_error(kShuttingDown);
}

void MapServices::onOtherVehicles(const OtherVehiclesConstPtr& message) {
  try {
    mapping_->ignore(toIgnoredSpheres(*message, config_.map_frame));
  } catch (const std::invalid_argument& error) {
    ROS_WARN_THROTTLE_NAMED(kWarningPeriod, "map", "%s", error.what());
  }
}

bool MapServices::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = mapping_->reset();
  response.message = response.success ? "the map is empty" : kShuttingDown;
  return true;
}

bool MapServices::onGetBox(GetBox::Request& request, GetBox::Response& response) {
  return answer(&response, [&](const Snapshot& snapshot) {
    return queryBox(snapshot, request, config_.map_frame);
  });
}

bool MapServices::onQueryPoints(QueryPoints::Request& request, QueryPoints::Response& response) {
  return answer(&response, [&](const Snapshot& snapshot) {
    return queryPoints(snapshot, request, config_.map_frame);
  });
}

bool MapServices::onCastRays(CastRays::Request& request, CastRays::Response& response) {
  return answer(&response, [&](const Snapshot& snapshot) {
    return castRays(snapshot, request, config_.map_frame);
  });
}

bool MapServices::onClearBox(ClearBox::Request& request, ClearBox::Response& response) {
  return fillOrRefuse(&response, [&] {
    edit(&response, [&](Mapper* mapper) { return clearBox(request, mapper); });
  });
}

bool MapServices::onSaveMap(SaveMap::Request& request, SaveMap::Response& response) {
  const std::lock_guard<std::mutex> lock(files_mutex_);
  return answer(&response, [&](const Snapshot& snapshot) {
    SaveMap::Response saved;
    saved.message = saveMap(snapshot, config_.save_directory, request.name);
    saved.success = true;
    return saved;
  });
}

bool MapServices::onLoadMap(LoadMap::Request& request, LoadMap::Response& response) {
  const std::lock_guard<std::mutex> lock(files_mutex_);
  return fillOrRefuse(&response, [&] {
    const SavedMap saved = readMap(config_.save_directory, request.name);
    edit(&response, [&](Mapper* mapper) { return loadMap(saved, request, mapper); });
  });
}

}  // namespace fiimap
