#include "simulator_publisher.h"

#include <rosgraph_msgs/Clock.h>

#include <boost/make_shared.hpp>

#include "fiimap/ros/stamps.h"
#include "simulator_messages.h"

namespace fiimap::sim {
namespace {

const ros::Time kSimulatedStart(1000.0);  // late enough for buffers that look back
constexpr int kStateQueue = 100;
constexpr int kSensorQueue = 10;
constexpr int kMarkerQueue = 1;
constexpr double kMarkerRate = 10.0;  // Hz
constexpr bool kLatch = true;

/// As a shared pointer: nodelets of the same manager get it without a copy.
template <typename Message>
void publishShared(const ros::Publisher& publisher, Message message) {
  publisher.publish(boost::make_shared<const Message>(std::move(message)));
}

}  // namespace

SimulatorPublisher::SimulatorPublisher(ros::NodeHandle node, ros::NodeHandle private_node,
                                       const SimulatorConfig& config, const World& world)
    : config_(config), start_(config.publish_clock ? kSimulatedStart : ros::Time::now()) {
  using visualization_msgs::MarkerArray;
  if (config.publish_clock) {
    clock_publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", kStateQueue);
  }
  odometry_publisher_ = node.advertise<nav_msgs::Odometry>("odom", kStateQueue);
  transform_publisher_ = node.advertise<tf2_msgs::TFMessage>("/tf", kStateQueue);
  static_transform_publisher_ =
      node.advertise<tf2_msgs::TFMessage>("/tf_static", kStateQueue, kLatch);
  image_publisher_ = node.advertise<sensor_msgs::Image>("camera/depth/image_raw", kSensorQueue);
  camera_info_publisher_ =
      node.advertise<sensor_msgs::CameraInfo>("camera/depth/camera_info", kSensorQueue);
  cloud_publisher_ = node.advertise<sensor_msgs::PointCloud2>("points", kSensorQueue);
  truth_publisher_ = private_node.advertise<SimulatorTruth>("truth", kStateQueue);
  world_publisher_ = private_node.advertise<MarkerArray>("world", kMarkerQueue, kLatch);
  moving_publisher_ = private_node.advertise<MarkerArray>("moving", kMarkerQueue);
  publishStatic(world);
}

void SimulatorPublisher::publishStatic(const World& world) {
  const std_msgs::Header body = headerAt(0.0, config_.body_frame);
  tf2_msgs::TFMessage transforms;
  transforms.transforms.push_back(toTransform(config_.camera.T_B_C(), body, config_.camera_frame));
  if (config_.lidar.lidar != LidarKind::kNone) {
    transforms.transforms.push_back(toTransform(config_.lidar.T_B_L(), body, config_.lidar_frame));
  }
  static_transform_publisher_.publish(transforms);
  publishShared(world_publisher_, toWorldMarkers(world, headerAt(0.0, config_.world_frame)));
}

std_msgs::Header SimulatorPublisher::headerAt(double time, const std::string& frame) const {
  std_msgs::Header header;
  header.stamp = start_ + ros::Duration(time);
  header.frame_id = frame;
  return header;
}

double SimulatorPublisher::timeOf(const ros::Time& stamp) const {
  return secondsBetween(start_, stamp);
}

void SimulatorPublisher::publishState(Simulator& simulator) {
  if (simulator.odometryIsDue()) {
    if (config_.publish_clock) {
      rosgraph_msgs::Clock clock;
      clock.clock = start_ + ros::Duration(simulator.time());
      clock_publisher_.publish(clock);
    }
    publishTruth(simulator);
  }
  while (const std::optional<OdometrySample> sample = simulator.odometry()) {
    publishOdometry(*sample);
  }
  if (simulator.isDue(kMarkerRate) && moving_publisher_.getNumSubscribers() > 0) {
    publishShared(
        moving_publisher_,
        toMovingMarkers(simulator.scene().world(), simulator.time(), simulator.vehicle(),
                        config_.vehicle_radius, headerAt(simulator.time(), config_.world_frame)));
  }
}

void SimulatorPublisher::publishTruth(const Simulator& simulator) {
  publishShared(truth_publisher_, toTruth(simulator.vehicle(), simulator.record(),
                                          headerAt(simulator.time(), config_.world_frame)));
}

void SimulatorPublisher::publishOdometry(const OdometrySample& sample) {
  const std_msgs::Header header = headerAt(sample.time, config_.world_frame);
  publishShared(odometry_publisher_, toOdometry(sample, header, config_.body_frame));
  tf2_msgs::TFMessage transforms;
  transforms.transforms.push_back(toTransform(sample.T_O_B, header, config_.body_frame));
  publishShared(transform_publisher_, std::move(transforms));
}

void SimulatorPublisher::publishImage(double time, const std::vector<std::uint16_t>& millimetres) {
  const std_msgs::Header header = headerAt(time, config_.camera_frame);
  publishShared(camera_info_publisher_, toCameraInfo(config_.camera, header));
  publishShared(image_publisher_, toImage(millimetres, config_.camera, header));
}

void SimulatorPublisher::publishCloud(double time, const std::vector<Eigen::Vector3f>& points) {
  publishShared(cloud_publisher_, toCloud(points, headerAt(time, config_.lidar_frame)));
}

}  // namespace fiimap::sim
