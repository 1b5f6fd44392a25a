#include "changes_publisher.h"

#include <utility>

#include <fiimap/MapChanges.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/map_changes.h"

namespace fiimap {
namespace {

/// A link may be slow for so many messages before one is lost.
constexpr int kChangesQueue = 20;

}  // namespace

ChangesPublisher::ChangesPublisher(ros::NodeHandle node, const std::string& map_frame, double rate,
                                   double keyframe_period)
    : map_frame_(map_frame), thread_(rate, [this] { publish(); }) {
  publisher_ = node.advertise<MapChanges>(
      "changes", kChangesQueue,
      [this](const ros::SingleSubscriberPublisher&) { requestKeyframe(); });
  keyframe_timer_ = node.createWallTimer(ros::WallDuration(keyframe_period),
                                         [this](const ros::WallTimerEvent&) { requestKeyframe(); });
}

ChangesPublisher::~ChangesPublisher() {
  keyframe_timer_.stop();
  thread_.stop();
  // Only now, because the thread publishes; subscriber callbacks end here.
  publisher_.shutdown();
}

void ChangesPublisher::offer(std::shared_ptr<const Snapshot> snapshot) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = std::move(snapshot);
  }
  thread_.wake();
}

void ChangesPublisher::requestKeyframe() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wants_keyframe_ = true;
  }
  thread_.wake();
}

void ChangesPublisher::publish() {
  if (publisher_.getNumSubscribers() == 0) {
    published_ = nullptr;  // whoever comes next asks for a keyframe
    return;
  }
  std::shared_ptr<const Snapshot> newest;
  bool is_keyframe = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest = newest_;
    std::swap(is_keyframe, wants_keyframe_);
  }
  if (newest == published_ && !is_keyframe) return;
  const Snapshot* const before = is_keyframe ? nullptr : published_.get();
  // As a shared pointer: nodelets of the same manager get it without a copy.
  publisher_.publish(boost::make_shared<const MapChanges>(
      newest ? toMapChanges(*newest, before, map_frame_) : toEmptyKeyframe(headerOfNow())));
  published_ = newest;
}

std_msgs::Header ChangesPublisher::headerOfNow() const {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = map_frame_;
  return header;
}

}  // namespace fiimap
