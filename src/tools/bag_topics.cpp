#include "bag_topics.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

template <typename Message>
std::set<std::string> topicsOfType(const rosbag::Bag& bag) {
  std::set<std::string> topics;
  rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::DataType<Message>::value()));
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics.insert(connection->topic);
  }
  return topics;
}

/// The topic that the user named, that the node would subscribe to, or the only one of the type.
std::string choose(const std::string& named, const std::set<std::string>& candidates,
                   const std::string& parameter, const std::string& what,
                   const std::string& of_node = "") {
  if (!named.empty()) return named;
  if (candidates.count(of_node) != 0) return of_node;
  if (candidates.size() == 1) return *candidates.begin();
  std::string list;
  for (const std::string& topic : candidates) list += " " + topic;
  throw std::invalid_argument(candidates.empty()
                                  ? "the bag holds no " + what
                                  : "the bag holds several topics of " + what + ":" + list +
                                        "; name one with --set " + parameter + "=TOPIC");
}

/// Null when there is none.
template <typename Message>
boost::shared_ptr<Message> firstOf(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto message = instance.instantiate<Message>()) return message;
  }
  return nullptr;
}

struct ImageTopics {
  std::set<std::string> depth;
  std::string others;  ///< in words, with their encodings
};

/// Tells depth images from colour images by the first image of each topic.
ImageTopics imageTopicsIn(const rosbag::Bag& bag) {
  ImageTopics topics;
  for (const std::string& topic : topicsOfType<sensor_msgs::Image>(bag)) {
    const auto image = firstOf<sensor_msgs::Image>(bag, topic);
    if (!image) continue;
    if (isDepthEncoding(image->encoding)) {
      topics.depth.insert(topic);
    } else {
      topics.others += " " + topic + " (" + image->encoding + ")";
    }
  }
  return topics;
}

PoseSource poseSourceIn(const rosbag::Bag& bag) {
  if (!topicsOfType<nav_msgs::Odometry>(bag).empty()) return PoseSource::kOdometry;
  if (!topicsOfType<geometry_msgs::PoseStamped>(bag).empty()) return PoseSource::kPose;
  if (!topicsOfType<geometry_msgs::TransformStamped>(bag).empty()) return PoseSource::kTransform;
  return PoseSource::kTf;
}

template <typename Message>
void choosePoses(const rosbag::Bag& bag, bool frame_is_open, const std::string& what,
                 BagTopics* topics, NodeConfig* config) {
  topics->pose_topic = choose(topics->pose_topic, topicsOfType<Message>(bag), "pose_topic", what);
  if (!frame_is_open) return;
  const auto pose = firstOf<Message>(bag, topics->pose_topic);
  const std::string frame = pose ? plainFrame(pose->header.frame_id) : "";
  if (!frame.empty()) config->map_frame = frame;
}

/// The topics of the bag that may be a sensor's.
struct Candidates {
  ImageTopics images;
  std::set<std::string> infos, clouds;
};

void chooseScans(const Candidates& candidates, const SensorConfig& sensor,
                 SensorBagTopics* topics) {
  const std::string prefix = sensor.prefix();
  // Without a name the node's topics are common ones, which say nothing of a recording's.
  const std::string of_node = prefix.empty() ? "" : '/' + prefix;
  const std::string& others = candidates.images.others;
  if (sensor.sensor == SensorKind::kDepth) {
    std::string what = "sensor_msgs/Image of encoding 16UC1, mono16 or 32FC1";
    if (candidates.images.depth.empty() && !others.empty()) what += ", only" + others;
    topics->depth_topic = choose(topics->depth_topic, candidates.images.depth,
                                 prefix + "depth_topic", what, of_node + "depth/image");
    topics->camera_info_topic =
        choose(topics->camera_info_topic, candidates.infos, prefix + "camera_info_topic",
               "sensor_msgs/CameraInfo", of_node + "depth/camera_info");
  } else {
    std::string what = "sensor_msgs/PointCloud2";
    if (!others.empty()) what += " and no depth images, only" + others;
    topics->points_topic = choose(topics->points_topic, candidates.clouds, prefix + "points_topic",
                                  what, of_node + "points");
  }
}

template <typename... Messages>
void requireType(const rosbag::Bag& bag, const std::string& parameter, const std::string& topic) {
  if (topic.empty()) return;
  const std::vector<std::string> allowed = {ros::message_traits::DataType<Messages>::value()...};
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const std::string& type = connection->datatype;
    if (std::find(allowed.begin(), allowed.end(), type) != allowed.end()) continue;
    std::string list;
    for (const std::string& name : allowed) list += (list.empty() ? "" : " or ") + name;
    throw std::invalid_argument("parameter " + parameter + " = '" + topic + "': is of type " +
                                type + " in the bag, must be of " + list);
  }
}

void requireTypes(const rosbag::Bag& bag, const std::vector<SensorConfig>& sensors,
                  const BagTopics& topics) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string prefix = sensors[i].prefix();
    const SensorBagTopics& own = topics.sensors[i];
    requireType<sensor_msgs::Image>(bag, prefix + "depth_topic", own.depth_topic);
    requireType<sensor_msgs::CameraInfo>(bag, prefix + "camera_info_topic", own.camera_info_topic);
    requireType<sensor_msgs::PointCloud2>(bag, prefix + "points_topic", own.points_topic);
  }
  requireType<nav_msgs::Odometry, geometry_msgs::PoseStamped, geometry_msgs::TransformStamped>(
      bag, "pose_topic", topics.pose_topic);
}

/// Two sensors do not write one topic.
void requireOwnTopics(const std::vector<SensorConfig>& sensors, const BagTopics& topics) {
  std::map<std::string, std::string> reader;  // names of sensors by topic
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string& topic = topics.sensors[i].scans(sensors[i].sensor);
    const auto [first, is_new] = reader.emplace(topic, sensors[i].name);
    if (is_new) continue;
    const bool depth = sensors[i].sensor == SensorKind::kDepth;
    throw std::invalid_argument("the sensors " + first->second + " and " + sensors[i].name +
                                " would both be read from " + topic + "; name another with --set " +
                                sensors[i].prefix() + (depth ? "depth" : "points") +
                                "_topic=TOPIC");
  }
}

}  // namespace

std::vector<Parameter> BagTopics::parameters(const NodeConfig& config) {
  const std::vector<SensorConfig> all = config.allSensors();
  sensors.resize(all.size());
  std::vector<Parameter> list;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string prefix = all[i].prefix();
    SensorBagTopics& topics = sensors[i];
    list.push_back(textParameter(prefix + "depth_topic", &topics.depth_topic,
                                 "topic of the depth images in the bag"));
    list.push_back(textParameter(prefix + "camera_info_topic", &topics.camera_info_topic,
                                 "topic of their intrinsics"));
    list.push_back(textParameter(prefix + "points_topic", &topics.points_topic,
                                 "topic of the clouds in the bag"));
  }
  list.push_back(textParameter("pose_topic", &pose_topic, "topic of the poses in the bag"));
  return list;
}

BagTopics chooseTopics(const rosbag::Bag& bag, const ParameterMap& settings, BagTopics topics,
                       NodeConfig* config) {
  const Candidates candidates = {imageTopicsIn(bag), topicsOfType<sensor_msgs::CameraInfo>(bag),
                                 topicsOfType<sensor_msgs::PointCloud2>(bag)};
  topics.sensors.resize(config->allSensors().size());
  if (config->sensors.empty() && settings.count("sensor") == 0) {
    const SensorBagTopics& named = topics.sensors.front();
    const bool has_depth = named.points_topic.empty() && !candidates.infos.empty() &&
                           (!candidates.images.depth.empty() || !named.depth_topic.empty());
    config->sensor = has_depth ? SensorKind::kDepth : SensorKind::kPoints;
  }
  const std::vector<SensorConfig> sensors = config->allSensors();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    chooseScans(candidates, sensors[i], &topics.sensors[i]);
  }
  requireOwnTopics(sensors, topics);

  if (settings.count("pose_source") == 0) config->pose_source = poseSourceIn(bag);
  const bool frame_is_open = settings.count("map_frame") == 0;
  switch (config->pose_source) {
    case PoseSource::kOdometry:
      choosePoses<nav_msgs::Odometry>(bag, frame_is_open, "nav_msgs/Odometry", &topics, config);
      break;
    case PoseSource::kPose:
      choosePoses<geometry_msgs::PoseStamped>(bag, frame_is_open, "geometry_msgs/PoseStamped",
                                              &topics, config);
      break;
    case PoseSource::kTransform:
      choosePoses<geometry_msgs::TransformStamped>(
          bag, frame_is_open, "geometry_msgs/TransformStamped", &topics, config);
      break;
    case PoseSource::kTf:
      if (topicsOfType<tf2_msgs::TFMessage>(bag).empty()) {
        throw std::invalid_argument(
            "the bag holds no poses: no nav_msgs/Odometry, geometry_msgs/PoseStamped, "
            "geometry_msgs/TransformStamped or tf2_msgs/TFMessage");
      }
      break;
  }
  requireTypes(bag, sensors, topics);
  return topics;
}

}  // namespace fiimap
