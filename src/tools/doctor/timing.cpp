#include "doctor/timing.h"

namespace fiimap {
namespace {

constexpr bool kHasStamp = true;

TopicHealth tfTiming(const Examination& e) {
  TopicHealth slowest;
  if (!e.hasScans()) return slowest;
  for (const std::string& frame : e.frames.chainToRoot(e.sensorFrame())) {
    if (frame == e.setup.node.map_frame) break;
    if (!e.frames.moves(frame)) continue;
    const auto messages = e.frames.linkAbove(frame);
    const TopicHealth link =
        healthOf("/tf (" + frame + ")", "tf2_msgs/TFMessage", kHasStamp, timesOf(messages));
    if (slowest.messages == 0 || link.interval.median > slowest.interval.median) slowest = link;
  }
  return slowest;
}

}  // namespace

TopicHealth scanTiming(const ScanTopics& sensor, const Observation& seen) {
  const auto images = seen.images.find(sensor.depth_image);
  if (images != seen.images.end()) {
    return healthOf(images->first, seen.types.at(images->first), kHasStamp,
                    timesOf(images->second));
  }
  const auto clouds = seen.clouds.find(sensor.points);
  if (clouds == seen.clouds.end()) return {};
  return healthOf(clouds->first, seen.types.at(clouds->first), kHasStamp, timesOf(clouds->second));
}

TopicHealth poseTiming(const Examination& e) {
  if (e.setup.has_poses && e.setup.node.pose_source == PoseSource::kTf) return tfTiming(e);
  const auto poses = e.seen.poses.find(e.setup.poses);
  if (poses == e.seen.poses.end()) return {};
  return healthOf(poses->first, e.seen.types.at(poses->first), kHasStamp, timesOf(poses->second));
}

}  // namespace fiimap
