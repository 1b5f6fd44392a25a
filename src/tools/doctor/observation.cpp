#include "doctor/observation.h"

#include <fiimap/MapInfo.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

const std::string kMapHandle = "/map_handle";

template <typename Message>
std::string typeOf() {
  return ros::message_traits::DataType<Message>::value();
}

template <typename Message>
void append(const boost::shared_ptr<const Message>& message, const ros::Time& time,
            std::vector<Received<Message>>* all, Observation* observation) {
  all->push_back({message, time, observation->messages++});
}

}  // namespace

const char* const kPoseTypes[3] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                                   "geometry_msgs/TransformStamped"};

void observe(const std::string& topic, const sensor_msgs::ImageConstPtr& image,
             const ros::Time& time, Observation* observation) {
  observation->types[topic] = typeOf<sensor_msgs::Image>();
  if (isDepthEncoding(image->encoding)) observation->depth[topic].add(image);
  const auto description = boost::make_shared<sensor_msgs::Image>();
  description->header = image->header;
  description->width = image->width;
  description->height = image->height;
  description->encoding = image->encoding;
  append<sensor_msgs::Image>(description, time, &observation->images[topic], observation);
}

void observe(const std::string& topic, const sensor_msgs::CameraInfoConstPtr& info,
             const ros::Time& time, Observation* observation) {
  observation->types[topic] = typeOf<sensor_msgs::CameraInfo>();
  append(info, time, &observation->infos[topic], observation);
}

void observe(const std::string& topic, const sensor_msgs::PointCloud2ConstPtr& cloud,
             const ros::Time& time, Observation* observation) {
  observation->types[topic] = typeOf<sensor_msgs::PointCloud2>();
  if (!isOutputOfMap(topic, *observation)) observation->points[topic].add(*cloud);
  const auto description = boost::make_shared<sensor_msgs::PointCloud2>();
  description->header = cloud->header;
  description->width = cloud->width;
  description->height = cloud->height;
  description->fields = cloud->fields;
  append<sensor_msgs::PointCloud2>(description, time, &observation->clouds[topic], observation);
}

void observe(const std::string& topic, const geometry_msgs::TransformStamped& pose,
             const ros::Time& time, Observation* observation) {
  observation->types.emplace(topic, typeOf<geometry_msgs::TransformStamped>());
  append<geometry_msgs::TransformStamped>(boost::make_shared<geometry_msgs::TransformStamped>(pose),
                                          time, &observation->poses[topic], observation);
}

void observe(const std::string& topic, const tf2_msgs::TFMessageConstPtr& transforms,
             const ros::Time& time, Observation* observation) {
  observation->types[topic] = typeOf<tf2_msgs::TFMessage>();
  const bool is_static = topic == "/tf_static";
  append(transforms, time, is_static ? &observation->tf_static : &observation->tf, observation);
}

std::vector<std::string> mapsIn(const std::map<std::string, std::string>& types) {
  std::vector<std::string> names;
  for (const auto& [topic, type] : types) {
    const bool is_handle =
        type == typeOf<MapInfo>() && topic.size() > kMapHandle.size() &&
        topic.compare(topic.size() - kMapHandle.size(), std::string::npos, kMapHandle) == 0;
    if (is_handle) names.push_back(topic.substr(0, topic.size() - kMapHandle.size()));
  }
  return names;
}

bool isOutputOfMap(const std::string& topic, const Observation& observation) {
  const std::vector<std::string> maps = mapsIn(observation.types);
  return std::any_of(maps.begin(), maps.end(), [&topic](const std::string& map) {
    return topic.compare(0, map.size() + 1, map + '/') == 0;
  });
}

}  // namespace fiimap
