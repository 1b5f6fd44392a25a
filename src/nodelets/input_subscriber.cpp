#include "input_subscriber.h"

#include <algorithm>
#include <functional>

#include <ros/transport_hints.h>

namespace fiimap {
namespace {

// Much longer than our own queue, which counts what it drops; ROS's does not.
constexpr int kScanQueue = 100;
constexpr int kPoseQueue = 1000;

template <typename Message>
using Callback = boost::function<void(const boost::shared_ptr<const Message>&)>;

ros::TransportHints withoutDelay() { return ros::TransportHints().tcpNoDelay(); }

}  // namespace

InputSubscriber::InputSubscriber(const ros::NodeHandle& node, const NodeConfig& config,
                                 MappingThread* mapping)
    : node_(node), mapping_(mapping) {
  const std::vector<SensorConfig> sensors = config.allSensors();
  counts_.sensors = std::vector<SensorCounts>(sensors.size());
  const bool poses_from_tf = config.pose_source == PoseSource::kTf;
  const bool extrinsics_from_tf = std::any_of(
      sensors.begin(), sensors.end(),
      [](const SensorConfig& sensor) { return sensor.extrinsics == ExtrinsicsSource::kTf; });
  // First what scans need, so that the first scan finds it.
  if (poses_from_tf || extrinsics_from_tf) subscribeToTf(poses_from_tf);
  if (!poses_from_tf) subscribeToPoses(config);
  for (std::size_t i = 0; i < sensors.size(); ++i) subscribeToSensor(sensors[i], i);
}

InputSubscriber::~InputSubscriber() {
  for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
}

void InputSubscriber::subscribeToSensor(const SensorConfig& config, std::size_t sensor) {
  SensorTopics topics;
  topics.name = config.name;
  if (config.sensor == SensorKind::kPoints) {
    topics.scans = subscribeToScans<sensor_msgs::PointCloud2>(config.prefix() + "points", sensor);
    topics_.sensors.push_back(topics);
    return;
  }
  const Callback<sensor_msgs::CameraInfo> on_info =
      [this, sensor](const sensor_msgs::CameraInfoConstPtr& info) {
        ++counts_.sensors[sensor].camera_infos;
        mapping_->post(
            [info, sensor](ScanSynchronizer* synchronizer) { synchronizer->add(info, sensor); });
      };
  subscribers_.push_back(node_.subscribe<sensor_msgs::CameraInfo>(
      config.prefix() + "depth/camera_info", kScanQueue, on_info));
  topics.camera_infos = subscribers_.back().getTopic();
  topics.scans = subscribeToScans<sensor_msgs::Image>(config.prefix() + "depth/image", sensor);
  topics_.sensors.push_back(topics);
}

template <typename Message>
std::string InputSubscriber::subscribeToScans(const std::string& topic, std::size_t sensor) {
  const Callback<Message> on_scan = [this, sensor](const boost::shared_ptr<const Message>& scan) {
    ++counts_.sensors[sensor].scans;
    mapping_->addScan(scan, sensor);
  };
  subscribers_.push_back(node_.subscribe<Message>(topic, kScanQueue, on_scan));
  return subscribers_.back().getTopic();
}

void InputSubscriber::subscribeToPoses(const NodeConfig& config) {
  switch (config.pose_source) {
    case PoseSource::kPose:
      topics_.poses = subscribeToPoseTopic<geometry_msgs::PoseStamped>("pose");
      return;
    case PoseSource::kTransform:
      topics_.poses = subscribeToPoseTopic<geometry_msgs::TransformStamped>("transform");
      return;
    default:
      topics_.poses = subscribeToPoseTopic<nav_msgs::Odometry>("odom");
  }
}

template <typename Message>
std::string InputSubscriber::subscribeToPoseTopic(const std::string& topic) {
  const Callback<Message> on_pose = [this](const boost::shared_ptr<const Message>& pose) {
    ++counts_.poses;
    mapping_->post([pose](ScanSynchronizer* synchronizer) { synchronizer->add(*pose); });
  };
  subscribers_.push_back(
      node_.subscribe<Message>(topic, kPoseQueue, on_pose, ros::VoidConstPtr(), withoutDelay()));
  return subscribers_.back().getTopic();
}

// Not through a tf2_ros::TransformListener: transforms pass the same queue as all other input, so
// the order of arrival decides, as in a bag, and one thread owns them.
void InputSubscriber::subscribeToTf(bool gives_poses) {
  const auto subscribe = [this](const std::string& topic, bool is_static, bool counts_as_pose) {
    const Callback<tf2_msgs::TFMessage> on_tf = [=](const tf2_msgs::TFMessageConstPtr& message) {
      if (counts_as_pose) ++counts_.poses;
      mapping_->post([message, is_static](ScanSynchronizer* synchronizer) {
        synchronizer->addTf(*message, is_static);
      });
    };
    subscribers_.push_back(node_.subscribe<tf2_msgs::TFMessage>(
        topic, kPoseQueue, on_tf, ros::VoidConstPtr(), withoutDelay()));
    return subscribers_.back().getTopic();
  };
  subscribe("/tf_static", true, false);
  const std::string topic = subscribe("/tf", false, gives_poses);
  if (gives_poses) topics_.poses = topic;
}

}  // namespace fiimap
