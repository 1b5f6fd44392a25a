#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "doctor/cloud_figures.h"
#include "doctor/depth_figures.h"
#include "fiimap/parameters.h"

namespace fiimap {

/// A message with the moment of its receipt, or of its recording.
template <typename Message>
struct Received {
  boost::shared_ptr<const Message> message;
  ros::Time time;
  std::size_t order = 0;  ///< of arrival among the messages of all topics
};

template <typename Message>
using ReceivedByTopic = std::map<std::string, std::vector<Received<Message>>>;

/// Topics of one sensor that a mapping node listens to, with all remappings.
struct ListenedTopics {
  std::string scans;
  std::string camera_info;  ///< empty: it needs none
};

/// A mapping node that runs while the graph is looked at.
struct RunningMap {
  std::string name;                           ///< full, with '/'
  std::string manager;                        ///< full name of its nodelet manager; empty: none
  ParameterMap parameters;                    ///< as it has them
  std::map<std::string, std::string> inputs;  ///< types of the topics that it listens to, by name
  std::map<std::string, ListenedTopics> sensors;  ///< as /diagnostics says, by name of the sensor
  std::vector<std::string> errors;                ///< that /diagnostics said of it last
  std::vector<std::string> warnings;              ///< likewise
};

/// What a live graph or a bag showed in some seconds. Live and recorded messages look the same.
struct Observation {
  std::string bag;                           ///< file; empty: a live graph
  double seconds = 0.0;                      ///< how long it was looked at
  std::map<std::string, std::string> types;  ///< of all topics there are, by name
  std::size_t messages = 0;

  ReceivedByTopic<sensor_msgs::Image> images;  ///< without their data
  std::map<std::string, DepthFigures> depth;   ///< what the data of depth images are, by topic
  ReceivedByTopic<sensor_msgs::CameraInfo> infos;
  ReceivedByTopic<sensor_msgs::PointCloud2> clouds;        ///< without their data
  std::map<std::string, CloudFigures> points;              ///< what their data are, by topic
  ReceivedByTopic<geometry_msgs::TransformStamped> poses;  ///< of every type of poses, by topic
  std::vector<Received<tf2_msgs::TFMessage>> tf;
  std::vector<Received<tf2_msgs::TFMessage>> tf_static;

  std::size_t clock_messages = 0;  ///< on /clock
  bool use_sim_time = false;       ///< live only
  std::optional<RunningMap> map;   ///< live only

  bool live() const { return bag.empty(); }
};

/// Message types of poses in the order in which they are preferred: odometry, pose, transform.
extern const char* const kPoseTypes[3];

/// Adds a message.
void observe(const std::string& topic, const sensor_msgs::ImageConstPtr& image,
             const ros::Time& time, Observation* observation);
void observe(const std::string& topic, const sensor_msgs::CameraInfoConstPtr& info,
             const ros::Time& time, Observation* observation);
void observe(const std::string& topic, const sensor_msgs::PointCloud2ConstPtr& cloud,
             const ros::Time& time, Observation* observation);
void observe(const std::string& topic, const geometry_msgs::TransformStamped& pose,
             const ros::Time& time, Observation* observation);
/// \param topic what begins with /tf_static is static.
void observe(const std::string& topic, const tf2_msgs::TFMessageConstPtr& transforms,
             const ros::Time& time, Observation* observation);

/// Whether a topic is an output of a mapping node, which is known by the types of its topics.
bool isOutputOfMap(const std::string& topic, const Observation& observation);

/// Names of mapping nodes, with '/'.
std::vector<std::string> mapsIn(const std::map<std::string, std::string>& types);

}  // namespace fiimap
