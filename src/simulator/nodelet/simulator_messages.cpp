#include "simulator_messages.h"

#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace fiimap::sim {
namespace {

template <typename Message>
Eigen::Vector3d toVector(const Message& message) {
  return {message.x, message.y, message.z};
}

template <typename Message>
Message fromVector(const Eigen::Vector3d& vector) {
  Message message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Quaternion toQuaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

}  // namespace

Setpoint toSetpoint(const trajectory_msgs::MultiDOFJointTrajectory& command,
                    const std::string& frame) {
  const std::string& its_frame = command.header.frame_id;
  if (its_frame != frame) {
    throw std::invalid_argument("its frame is '" + its_frame + "', it must be '" + frame + "'");
  }
  if (command.header.stamp.isZero()) throw std::invalid_argument("its stamp is not set");
  if (command.points.size() != 1 || command.points[0].transforms.size() != 1) {
    throw std::invalid_argument("it must have exactly one point with one transform");
  }
  const trajectory_msgs::MultiDOFJointTrajectoryPoint& point = command.points[0];
  Setpoint setpoint;
  setpoint.position_W = toVector(point.transforms[0].translation);
  if (!point.velocities.empty()) setpoint.velocity_W = toVector(point.velocities[0].linear);
  if (!point.accelerations.empty()) {
    setpoint.acceleration_W = toVector(point.accelerations[0].linear);
  }
  const geometry_msgs::Quaternion& q = point.transforms[0].rotation;
  const Eigen::Vector3d forward_W =
      Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized() * Eigen::Vector3d::UnitX();
  setpoint.yaw = std::atan2(forward_W.y(), forward_W.x());
  const bool finite = setpoint.position_W.allFinite() && setpoint.velocity_W.allFinite() &&
                      setpoint.acceleration_W.allFinite() && forward_W.allFinite();
  if (!finite) throw std::invalid_argument("it must hold finite numbers only");
  return setpoint;
}

nav_msgs::Odometry toOdometry(const OdometrySample& sample, const std_msgs::Header& header,
                              const std::string& body_frame) {
  nav_msgs::Odometry odometry;
  odometry.header = header;
  odometry.child_frame_id = body_frame;
  odometry.pose.pose.position = fromVector<geometry_msgs::Point>(sample.T_O_B.translation());
  odometry.pose.pose.orientation = toQuaternion(sample.T_O_B.linear());
  odometry.twist.twist.linear = fromVector<geometry_msgs::Vector3>(sample.velocity_B);
  odometry.twist.twist.angular.z = sample.yaw_rate;
  return odometry;
}

geometry_msgs::TransformStamped toTransform(const Eigen::Isometry3d& T_parent_child,
                                            const std_msgs::Header& header,
                                            const std::string& child_frame) {
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = child_frame;
  transform.transform.translation =
      fromVector<geometry_msgs::Vector3>(T_parent_child.translation());
  transform.transform.rotation = toQuaternion(T_parent_child.linear());
  return transform;
}

SimulatorTruth toTruth(const Quadrotor::State& vehicle, const FlightRecord& record,
                       const std_msgs::Header& header) {
  SimulatorTruth truth;
  truth.header = header;
  truth.position = fromVector<geometry_msgs::Point>(vehicle.position_W);
  truth.velocity = fromVector<geometry_msgs::Vector3>(vehicle.velocity_W);
  truth.clearance = record.clearance;
  truth.least_clearance = record.least_clearance;
  truth.collisions = record.collisions;
  truth.path_length = record.path_length;
  return truth;
}

sensor_msgs::Image toImage(const std::vector<std::uint16_t>& millimetres,
                           const CameraConfig& camera, const std_msgs::Header& header) {
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<std::uint32_t>(camera.image_width);
  image.height = static_cast<std::uint32_t>(camera.image_height);
  image.encoding = sensor_msgs::image_encodings::TYPE_16UC1;
  image.is_bigendian = 0;
  image.step = image.width * sizeof(std::uint16_t);
  image.data.resize(millimetres.size() * sizeof(std::uint16_t));
  std::memcpy(image.data.data(), millimetres.data(), image.data.size());
  return image;
}

sensor_msgs::CameraInfo toCameraInfo(const CameraConfig& camera, const std_msgs::Header& header) {
  const double f = camera.focalLength();
  const Eigen::Vector2d c = camera.center();
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<std::uint32_t>(camera.image_width);
  info.height = static_cast<std::uint32_t>(camera.image_height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {f, 0.0, c.x(), 0.0, f, c.y(), 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {f, 0.0, c.x(), 0.0, 0.0, f, c.y(), 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

sensor_msgs::PointCloud2 toCloud(const std::vector<Eigen::Vector3f>& points,
                                 const std_msgs::Header& header) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(3, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1,
                                sensor_msgs::PointField::FLOAT32, "z", 1,
                                sensor_msgs::PointField::FLOAT32);
  modifier.resize(points.size());
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "points lie as in the message");
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  cloud.is_dense = true;
  return cloud;
}

}  // namespace fiimap::sim
