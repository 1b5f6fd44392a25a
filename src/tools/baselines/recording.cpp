#include "recording.h"

#include <rosbag/bag.h>

#include <stdexcept>

#include "bag_player.h"
#include "bag_topics.h"

namespace fiimap::bench {
namespace {

/// Ends the reading of a bag: unpacking the rest would take longer than the measurements.
struct EnoughFrames {};

class FrameCollector : public ScanListener {
 public:
  FrameCollector(std::size_t max_frames, std::vector<Frame>* frames)
      : max_frames_(max_frames), frames_(frames) {}

  void onScan(const SynchronizedScan& scan) override {
    if (!std::holds_alternative<sensor_msgs::ImageConstPtr>(scan.message)) return;
    frames_->push_back(frameOf(scan, 1));
    if (frames_->size() == max_frames_) throw EnoughFrames();
  }
  void onDrop(const Drop& /*drop*/, std::size_t /*sensor*/) override {}
  void onTimeJump(const std::string& /*what*/) override {}
  void onWarning(const std::string& /*text*/) override {}

 private:
  std::size_t max_frames_;
  std::vector<Frame>* frames_;
};

}  // namespace

Frame frameOf(const SynchronizedScan& scan, int pixel_step) {
  Frame frame;
  frame.pose = scan.pose;
  if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&scan.message)) {
    frame.image = decodeDepthImage(*image);
    frame.intrinsics = scan.intrinsics;
  } else {
    const auto& cloud = std::get<sensor_msgs::PointCloud2ConstPtr>(scan.message);
    decodePointCloud(*cloud, pixel_step, &frame.points.emplace());
  }
  return frame;
}

ScanReport integrate(const Frame& frame, Mapper* mapper) {
  if (frame.points) return mapper->integrate(*frame.points, frame.pose);
  return mapper->integrate(frame.image.view, frame.intrinsics, frame.pose);
}

Recording loadRecording(const std::string& name, const std::string& bag_path,
                        std::size_t max_frames) {
  Recording recording;
  recording.name = name;
  rosbag::Bag bag(bag_path, rosbag::bagmode::Read);
  NodeConfig config;
  const BagTopics topics = chooseTopics(bag, ParameterMap(), BagTopics(), &config);
  FrameCollector collector(max_frames, &recording.frames);
  ScanCounters counters;
  try {
    BagPlayer(bag, topics, config).play(&collector, &counters);
  } catch (const EnoughFrames&) {
  }
  if (recording.frames.empty()) throw std::runtime_error(bag_path + ": no depth image with a pose");
  return recording;
}

Recording loadRecording(const std::string& name_and_bag, std::size_t max_frames) {
  const std::size_t equals = name_and_bag.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == name_and_bag.size()) {
    throw std::invalid_argument("--bag " + name_and_bag + ": must be NAME=FILE");
  }
  return loadRecording(name_and_bag.substr(0, equals), name_and_bag.substr(equals + 1), max_frames);
}

}  // namespace fiimap::bench
