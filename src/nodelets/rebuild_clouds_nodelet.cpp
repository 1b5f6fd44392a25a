#include "rebuild_clouds_nodelet.h"

#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include "fiimap/parameters.h"
#include "fiimap/ros/map_messages.h"
#include "fiimap/ros/parameter_sources.h"

namespace fiimap {
namespace {

constexpr int kReceivedQueue = 100;
constexpr int kRebuiltQueue = 1;
constexpr double kMaxRebuiltMemory = 1e6;   // MB
constexpr double kMissingMapPeriod = 10.0;  // s, between warnings and before the first

std::vector<Parameter> rebuildParameters(double* memory_limit) {
  return {numberParameter("memory_limit", memory_limit, 0.0, kMaxRebuiltMemory, "MB",
                          "a map that may need more when all is seen is refused; 0: the "
                          "machine's memory")};
}

}  // namespace

void RebuildCloudsNodelet::onInit() {
  try {
    for (const std::string& name : applyParameters(parameterMapFromRos(getPrivateNodeHandle()),
                                                   rebuildParameters(&memory_limit_))) {
      NODELET_WARN("parameter %s is unknown and has no effect", name.c_str());
    }
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
  ros::NodeHandle& node = getPrivateNodeHandle();
  const auto on_connect = [this](const ros::SingleSubscriberPublisher&) { onSubscribers(); };
  const std::lock_guard<std::mutex> lock(mutex_);  // somebody may subscribe at once
  occupied_ =
      node.advertise<sensor_msgs::PointCloud2>("occupied", kRebuiltQueue, on_connect, on_connect);
  inflated_ =
      node.advertise<sensor_msgs::PointCloud2>("inflated", kRebuiltQueue, on_connect, on_connect);
  window_ =
      node.advertise<visualization_msgs::Marker>("window", kRebuiltQueue, on_connect, on_connect);
  missing_timer_ =
      getNodeHandle().createWallTimer(ros::WallDuration(kMissingMapPeriod),
                                      [this](const ros::WallTimerEvent&) { onMissingTimer(); });
}

RebuildCloudsNodelet::~RebuildCloudsNodelet() {
  // Nothing may call back any more before that goes which callbacks use.
  missing_timer_.stop();
  for (ros::Publisher* publisher : {&occupied_, &inflated_, &window_}) publisher->shutdown();
  changes_.shutdown();
}

/// Somebody subscribed or went.
void RebuildCloudsNodelet::onSubscribers() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto subscribers =
      occupied_.getNumSubscribers() + inflated_.getNumSubscribers() + window_.getNumSubscribers();
  if (subscribers == 0) {
    changes_.shutdown();
    reader_ = nullptr;
    shown_ = nullptr;
    snapshot_ = nullptr;
  } else if (reader_) {
    publishMap();
  } else {
    reader_ = std::make_unique<MapChangesReader>(memory_limit_);
    // The mapping node answers with a keyframe.
    changes_ = getNodeHandle().subscribe("changes", kReceivedQueue,
                                         &RebuildCloudsNodelet::onChanges, this);
  }
}

void RebuildCloudsNodelet::onChanges(const MapChangesConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!reader_) return;  // on its way when the last subscriber went
  try {
    switch (reader_->read(*message)) {
      case MapChangesReader::Result::kLost:
        NODELET_WARN(
            "messages on %s were lost before update %lu of the map: waiting for the next keyframe; "
            "a link that is too narrow needs a lower publish_rate",
            changes_.getTopic().c_str(), static_cast<unsigned long>(message->sequence));
        return;
      case MapChangesReader::Result::kWaiting:
        return;
      case MapChangesReader::Result::kMap:
      case MapChangesReader::Result::kNoMap:
        break;
    }
  } catch (const std::exception& error) {  // malformed, or too large for the memory
    NODELET_ERROR("%s: waiting for the next keyframe", error.what());
    return;
  }
  shown_ = message;
  snapshot_ = reader_->snapshot();
  publishMap();
}

void RebuildCloudsNodelet::publishMap() const {
  if (!shown_) return;
  publishCloud(occupied_, Plane::kOccupied);
  publishCloud(inflated_, Plane::kInflated);
  if (!snapshot_ || window_.getNumSubscribers() == 0) return;
  window_.publish(toOutline(snapshot_->window(), *snapshot_, shown_->header.frame_id, "window"));
}

void RebuildCloudsNodelet::publishCloud(const ros::Publisher& publisher, Plane plane) const {
  if (publisher.getNumSubscribers() == 0) return;
  publisher.publish(boost::make_shared<const sensor_msgs::PointCloud2>(
      snapshot_ ? toPointCloud(*snapshot_, plane, shown_->header.frame_id)
                : emptyCloud(shown_->header)));
}

void RebuildCloudsNodelet::onMissingTimer() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!reader_ || shown_) return;
  NODELET_WARN("no map received on %s: check that the mapping node runs and the topic is remapped",
               changes_.getTopic().c_str());
}

}  // namespace fiimap

PLUGINLIB_EXPORT_CLASS(fiimap::RebuildCloudsNodelet, nodelet::Nodelet)
