#include "doctor/bag_observation.h"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <type_traits>

#include "bag_check.h"
#include "fiimap/ros/pose_messages.h"

namespace fiimap {
namespace {

template <typename Message>
bool observeAs(const rosbag::MessageInstance& instance, Observation* observation) {
  if (!instance.isType<Message>()) return false;
  const boost::shared_ptr<const Message> message = instance.instantiate<Message>();
  if constexpr (std::is_same_v<Message, nav_msgs::Odometry> ||
                std::is_same_v<Message, geometry_msgs::PoseStamped>) {
    observe(instance.getTopic(), toTransform(*message), instance.getTime(), observation);
  } else if constexpr (std::is_same_v<Message, geometry_msgs::TransformStamped>) {
    observe(instance.getTopic(), *message, instance.getTime(), observation);
  } else if constexpr (std::is_same_v<Message, rosgraph_msgs::Clock>) {
    ++observation->clock_messages;
  } else {
    observe(instance.getTopic(), message, instance.getTime(), observation);
  }
  return true;
}

template <typename... Messages>
void observeAny(const rosbag::MessageInstance& instance, Observation* observation) {
  (observeAs<Messages>(instance, observation) || ...);
}

void observeInstance(const rosbag::MessageInstance& instance, Observation* observation) {
  observeAny<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::PointCloud2,
             nav_msgs::Odometry, geometry_msgs::PoseStamped, geometry_msgs::TransformStamped,
             tf2_msgs::TFMessage, rosgraph_msgs::Clock>(instance, observation);
}

}  // namespace

Observation observeBag(const std::string& file, double start, double seconds) {
  rosbag::Bag bag;
  openBag(file, &bag);
  Observation observation;
  observation.bag = std::filesystem::absolute(file).lexically_normal().string();
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
    observation.types[connection->topic] = connection->datatype;
  }
  if (all.size() == 0) return observation;
  const ros::Time begin = all.getBeginTime() + ros::Duration(start);
  const ros::Time end = begin + ros::Duration(seconds);
  if (begin > all.getEndTime()) {
    throw std::invalid_argument("the bag " + file + " ends " +
                                std::to_string((all.getEndTime() - all.getBeginTime()).toSec()) +
                                " s after its beginning, before --start");
  }
  observation.seconds = (std::min(end, all.getEndTime()) - begin).toSec();
  rosbag::View before(bag, rosbag::TopicQuery(std::string("/tf_static")), all.getBeginTime(),
                      begin);
  if (start > 0.0) {
    for (const rosbag::MessageInstance& instance : before) observeInstance(instance, &observation);
  }
  rosbag::View part(bag, begin, end);
  for (const rosbag::MessageInstance& instance : part) observeInstance(instance, &observation);
  return observation;
}

}  // namespace fiimap
