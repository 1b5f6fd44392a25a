#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "doctor/diagnosis.h"
#include "doctor/observation.h"

namespace fiimap {

constexpr double kSeconds = 3.0;  // how long it is seen
constexpr bool kComes = true;     // of a message

/// What is seen of a vehicle that flies ahead at 1 m/s, with all in order until a test changes it:
/// a depth camera that looks ahead at a wall 3 m away, its place in TF, odometry.
class SeenVehicle {
 public:
  SeenVehicle();

  // What tests change. Each is called for every message before it is seen; false: it does not come.
  std::function<bool(sensor_msgs::Image*)> image = [](auto*) { return true; };
  std::function<bool(sensor_msgs::CameraInfo*)> info = [](auto*) { return true; };
  std::function<bool(sensor_msgs::PointCloud2*)> cloud = [](auto*) { return false; };
  std::function<bool(geometry_msgs::TransformStamped*)> pose = [](auto*) { return true; };
  std::string image_topic = "/camera/depth/image_rect_raw";
  std::string info_topic = "/camera/depth/camera_info";
  std::string cloud_topic = "/points";
  std::string pose_topic = "/odom";
  std::string pose_type = "nav_msgs/Odometry";
  double image_rate = 10.0, pose_rate = 100.0;                     // Hz
  double image_delay = 0.05, pose_delay = 0.002;                   // s
  std::vector<geometry_msgs::TransformStamped> static_transforms;  // base_link -> camera_optical
  std::vector<geometry_msgs::TransformStamped> transforms;         // on /tf, with every pose
  bool pose_on_tf = false;

  /// Other facts, set after the messages.
  std::function<void(Observation*)> more = [](Observation*) {};

  Observation observation() const;
  Diagnosis diagnosis(const DoctorWishes& wishes = {}) const;
};

/// Static or moving transform with the rotation x y z w.
geometry_msgs::TransformStamped transformOf(const std::string& parent, const std::string& child,
                                            const Eigen::Quaterniond& rotation,
                                            const Eigen::Vector3d& translation = {0.1, 0.0, 0.0});

/// A depth image of one value. \param metres of 32-bit images; units of 16-bit ones.
void fillImage(double value, const std::string& encoding, sensor_msgs::Image* image);

/// A cloud of points, x y z in float32.
void fillCloud(const std::vector<Eigen::Vector3f>& points, sensor_msgs::PointCloud2* cloud);

/// The finding of a severity whose sentences hold all words; fails where there is none.
Finding expectFinding(const Diagnosis& diagnosis, Severity severity,
                      const std::vector<std::string>& words);

/// No errors and no warnings; fails with them otherwise.
void expectNothingWrong(const Diagnosis& diagnosis);

/// Words of the launch line, joined by spaces; empty where there is none.
std::string launchLine(const Diagnosis& diagnosis);

void expectContains(const std::string& text, const std::string& part);

}  // namespace fiimap
