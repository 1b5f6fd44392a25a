#include "bag_player.h"

#include <rosbag/view.h>

#include <vector>

namespace fiimap {
namespace {

constexpr char kTf[] = "/tf";
constexpr char kStaticTf[] = "/tf_static";

template <typename PoseMessage>
void addPose(const rosbag::MessageInstance& instance, ScanSynchronizer* synchronizer) {
  if (const auto message = instance.instantiate<PoseMessage>()) synchronizer->add(*message);
}

}  // namespace

BagPlayer::BagPlayer(const rosbag::Bag& bag, const BagTopics& topics, const NodeConfig& config)
    : bag_(&bag), topics_(topics), config_(config) {}

std::size_t BagPlayer::scans() const {
  const bool depth = config_.sensor == SensorKind::kDepth;
  return rosbag::View(*bag_, rosbag::TopicQuery(depth ? topics_.depth_topic : topics_.points_topic))
      .size();
}

void BagPlayer::play(ScanListener* listener, ScanCounters* counters) {
  ScanSynchronizer synchronizer(config_, listener);
  const auto addScan = [&](const ScanMessage& scan) {
    ++counters->received;
    synchronizer.add(scan);
  };

  std::vector<std::string> wanted = {topics_.pose_topic, kTf, kStaticTf};
  if (config_.sensor == SensorKind::kDepth) {
    wanted.insert(wanted.end(), {topics_.depth_topic, topics_.camera_info_topic});
  } else {
    wanted.push_back(topics_.points_topic);
  }
  rosbag::View view(*bag_, rosbag::TopicQuery(wanted));
  for (const rosbag::MessageInstance& instance : view) {
    const std::string& topic = instance.getTopic();
    if (const auto image = instance.instantiate<sensor_msgs::Image>()) {
      addScan(sensor_msgs::ImageConstPtr(image));
    } else if (const auto cloud = instance.instantiate<sensor_msgs::PointCloud2>()) {
      addScan(sensor_msgs::PointCloud2ConstPtr(cloud));
    } else if (const auto info = instance.instantiate<sensor_msgs::CameraInfo>()) {
      synchronizer.add(sensor_msgs::CameraInfoConstPtr(info));
    } else if (const auto transforms = instance.instantiate<tf2_msgs::TFMessage>()) {
      synchronizer.addTf(*transforms, topic == kStaticTf);
    } else {
      addPose<nav_msgs::Odometry>(instance, &synchronizer);
      addPose<geometry_msgs::PoseStamped>(instance, &synchronizer);
      addPose<geometry_msgs::TransformStamped>(instance, &synchronizer);
    }
  }
  synchronizer.finish();
}

}  // namespace fiimap
