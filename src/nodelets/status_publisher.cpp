#include "status_publisher.h"

#include <boost/make_shared.hpp>

#include "status_markers.h"

namespace fiimap {
namespace {

constexpr int kStatusQueue = 1;

}  // namespace

StatusPublisher::StatusPublisher(ros::NodeHandle node, const std::string& map_frame, double rate)
    : map_frame_(map_frame), thread_(rate, [this] { publish(); }) {
  publisher_ = node.advertise<visualization_msgs::MarkerArray>(
      "status", kStatusQueue, [this](const ros::SingleSubscriberPublisher&) { onSubscriber(); });
}

StatusPublisher::~StatusPublisher() {
  thread_.stop();
  publisher_.shutdown();  // only now, because the thread publishes; subscriber callbacks end here
}

void StatusPublisher::offer(const MapUpdate& update) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    update_ = update;
  }
  thread_.wake();
}

void StatusPublisher::clear() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    update_.reset();
  }
  thread_.wake();
}

void StatusPublisher::onSubscriber() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!update_) return;
  }
  thread_.wake();
}

void StatusPublisher::publish() {
  if (publisher_.getNumSubscribers() == 0) {
    shown_.reset();  // an old snapshot keeps copies of what changed since
    return;
  }
  std::optional<MapUpdate> update;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    update = update_;
  }
  const auto markers = boost::make_shared<const visualization_msgs::MarkerArray>(
      update ? toStatusMarkers(*update, shown_.get(), map_frame_) : noStatusMarkers(map_frame_));
  shown_ = update ? update->snapshot : nullptr;
  publisher_.publish(markers);
}

}  // namespace fiimap
