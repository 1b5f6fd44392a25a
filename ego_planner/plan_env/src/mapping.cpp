#include "mapping.h"

#include <stdexcept>
#include <utility>

#include <sensor_msgs/CameraInfo.h>

namespace {

constexpr int kQueue = 1;
constexpr bool kProvideServices = false;

}  // namespace

GridMap::Mapping::Mapping(ros::NodeHandle& nh, const EgoParameters& ego, OnSnapshot on_snapshot)
    : ego_(ego),
      on_snapshot_(std::move(on_snapshot)),
      topics_((ego.is_version_2 ? nh.getNamespace() : "") + "/grid_map/"),
      loader_(kProvideServices),
      spinner_(1, &queue_) {
  const std::string name = nh.getNamespace() + "/fiimap";
  node_.setCallbackQueue(&queue_);
  if (ros::param::has(name)) ros::param::del(name);
  for (const auto& [key, value] : ego_.mapping) ros::param::set(name + "/" + key, value);
  if (ego_.has_cloud_sensor) {
    relay_ = std::make_unique<WorldCloudRelay>(
        node_, WorldCloudRelay::Topics{topics_ + "cloud", topics_ + "odom", topics_ + "pose",
                                       name + "/points", name + "/pose"});
  } else {
    const bool latch = true;
    info_publisher_ =
        node_.advertise<sensor_msgs::CameraInfo>(name + "/camera_info", kQueue, latch);
    image_subscriber_ = node_.subscribe(topics_ + "depth", kQueue, &Mapping::onFirstImage, this);
  }
  load(name);
  map_subscriber_ = nh.subscribe(name + "/map_handle", kQueue, &Mapping::onMap, this);
  spinner_.start();
}

GridMap::Mapping::~Mapping() {
  map_subscriber_.shutdown();
  spinner_.stop();
  relay_.reset();
  loader_.clear();
}

void GridMap::Mapping::load(const std::string& name) {
  const auto resolved = [](const std::string& topic) { return ros::names::resolve(topic); };
  const auto ego = [this](const std::string& topic) {
    return ros::names::resolve(topics_ + topic);
  };
  nodelet::M_string remappings = {{resolved("depth/image"), ego("depth")},
                                  {resolved("depth/camera_info"), name + "/camera_info"},
                                  {resolved("points"), name + "/points"},
                                  {resolved("odom"), ego("odom")},
                                  {resolved("pose"), ego("pose")},
                                  {name + "/occupied", ego("occupancy")},
                                  {name + "/inflated", ego("occupancy_inflate")}};
  if (ego_.has_cloud_sensor) remappings[resolved("pose")] = name + "/pose";
  // The nodelet's relative names lie beside its own name.
  const std::string space = name.substr(0, name.rfind('/')) + "/";
  for (const char* const input : {"depth/image", "depth/camera_info", "points", "odom", "pose"}) {
    remappings[space + input] = remappings[resolved(input)];
  }
  if (!loader_.load(name, "fiimap/MappingNodelet", remappings, {})) {
    throw std::runtime_error("the mapping nodelet could not be loaded; see the messages above");
  }
}

void GridMap::Mapping::onMap(const fiimap::MapHandleMessage::ConstPtr& message) {
  if (message->handle) on_snapshot_(message->handle->latest());
}

void GridMap::Mapping::onFirstImage(const sensor_msgs::Image::ConstPtr& image) {
  // Intrinsics come from parameters; the image says its size.
  sensor_msgs::CameraInfo info;
  info.header = image->header;
  info.width = image->width;
  info.height = image->height;
  info.K = {ego_.fx, 0.0, ego_.cx, 0.0, ego_.fy, ego_.cy, 0.0, 0.0, 1.0};
  info.P = {ego_.fx, 0.0, ego_.cx, 0.0, 0.0, ego_.fy, ego_.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  info_publisher_.publish(info);
  image_subscriber_.shutdown();
}
