#include "bag_topics.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

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

/// The topic that the user named, or the only one of the type.
std::string choose(const std::string& named, const std::set<std::string>& candidates,
                   const std::string& parameter, const std::string& what) {
  if (!named.empty()) return named;
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

}  // namespace

std::vector<Parameter> BagTopics::parameters() {
  return {
      textParameter("depth_topic", &depth_topic, "topic of the depth images in the bag"),
      textParameter("camera_info_topic", &camera_info_topic, "topic of their intrinsics"),
      textParameter("points_topic", &points_topic, "topic of the clouds in the bag"),
      textParameter("pose_topic", &pose_topic, "topic of the poses in the bag"),
  };
}

BagTopics chooseTopics(const rosbag::Bag& bag, const ParameterMap& settings, BagTopics topics,
                       NodeConfig* config) {
  const ImageTopics images = imageTopicsIn(bag);
  const auto infos = topicsOfType<sensor_msgs::CameraInfo>(bag);
  if (settings.count("sensor") == 0) {
    const bool has_depth = topics.points_topic.empty() && !infos.empty() &&
                           (!images.depth.empty() || !topics.depth_topic.empty());
    config->sensor = has_depth ? SensorKind::kDepth : SensorKind::kPoints;
  }
  if (config->sensor == SensorKind::kDepth) {
    std::string what = "sensor_msgs/Image of encoding 16UC1, mono16 or 32FC1";
    if (images.depth.empty() && !images.others.empty()) what += ", only" + images.others;
    topics.depth_topic = choose(topics.depth_topic, images.depth, "depth_topic", what);
    topics.camera_info_topic =
        choose(topics.camera_info_topic, infos, "camera_info_topic", "sensor_msgs/CameraInfo");
  } else {
    std::string what = "sensor_msgs/PointCloud2";
    if (!images.others.empty()) what += " and no depth images, only" + images.others;
    topics.points_topic = choose(topics.points_topic, topicsOfType<sensor_msgs::PointCloud2>(bag),
                                 "points_topic", what);
  }

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
  return topics;
}

}  // namespace fiimap
