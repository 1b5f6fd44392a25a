#include "bag_player.h"

#include <rosbag/view.h>

#include <algorithm>
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
    : bag_(&bag), config_(config), pose_topic_(topics.pose_topic) {
  const std::vector<SensorConfig> sensors = config.allSensors();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const SensorBagTopics& own = topics.sensors.at(i);
    scan_topics_.push_back(own.scans(sensors[i].sensor));
    const bool depth = sensors[i].sensor == SensorKind::kDepth;
    info_topics_.push_back(depth ? own.camera_info_topic : "");
  }
}

std::size_t BagPlayer::scans() const {
  return rosbag::View(*bag_, rosbag::TopicQuery(scan_topics_)).size();
}

void BagPlayer::play(ScanListener* listener, ScanCounters* counters) {
  ScanSynchronizer synchronizer(config_, listener);
  counters->sensors.resize(config_.sensors.size());
  const auto addScan = [&](const ScanMessage& scan, const std::string& topic) {
    const auto found = std::find(scan_topics_.begin(), scan_topics_.end(), topic);
    const auto sensor = static_cast<std::size_t>(found - scan_topics_.begin());
    counters->countReceived(sensor);
    synchronizer.add(scan, Moment(), sensor);
  };

  std::vector<std::string> wanted = {pose_topic_, kTf, kStaticTf};
  wanted.insert(wanted.end(), scan_topics_.begin(), scan_topics_.end());
  wanted.insert(wanted.end(), info_topics_.begin(), info_topics_.end());
  rosbag::View view(*bag_, rosbag::TopicQuery(wanted));
  for (const rosbag::MessageInstance& instance : view) {
    const std::string& topic = instance.getTopic();
    if (const auto image = instance.instantiate<sensor_msgs::Image>()) {
      addScan(sensor_msgs::ImageConstPtr(image), topic);
    } else if (const auto cloud = instance.instantiate<sensor_msgs::PointCloud2>()) {
      addScan(sensor_msgs::PointCloud2ConstPtr(cloud), topic);
    } else if (const auto info = instance.instantiate<sensor_msgs::CameraInfo>()) {
      addInfo(info, topic, &synchronizer);
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

/// To all sensors that share them.
void BagPlayer::addInfo(const sensor_msgs::CameraInfoConstPtr& info, const std::string& topic,
                        ScanSynchronizer* synchronizer) const {
  for (std::size_t sensor = 0; sensor < info_topics_.size(); ++sensor) {
    if (info_topics_[sensor] == topic) synchronizer->add(info, sensor);
  }
}

}  // namespace fiimap
