#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "fiimap/mapper_config.h"
#include "fiimap/parameters.h"

namespace fiimap {

/// What a sensor sends.
enum class SensorKind {
  kDepth,   ///< sensor_msgs/Image with sensor_msgs/CameraInfo
  kPoints,  ///< sensor_msgs/PointCloud2
};

/// Which messages say where the vehicle is: the topic of that name, or /tf.
enum class PoseSource { kOdometry, kPose, kTransform, kTf };

/// Where the place of a sensor on the body comes from.
enum class ExtrinsicsSource {
  kTf,         ///< body to sensor frame from TF, at the scan's stamp
  kParameter,  ///< extrinsic_translation and extrinsic_rotation
};

/// What a sensor is, where it is and how its stamps are understood.
struct SensorConfig {
  std::string name;  ///< namespace of its topics and parameters; empty: without
  SensorKind sensor = SensorKind::kDepth;               ///< what it sends
  ExtrinsicsSource extrinsics = ExtrinsicsSource::kTf;  ///< where its place on the body comes from
  Eigen::Vector3d extrinsic_translation = Eigen::Vector3d::Zero();  ///< sensor to body, m
  Eigen::Vector4d extrinsic_rotation = Eigen::Vector4d::UnitW();    ///< sensor to body, x y z w
  double time_offset = 0.0;                                         ///< s, added to its stamps

  /// "name/", or nothing where there is no name.
  std::string prefix() const { return name.empty() ? "" : name + '/'; }
  /// Sensor to body from the parameters.
  Eigen::Isometry3d parameterExtrinsics() const;
  /// \throws std::invalid_argument that names the parameter, its value and what is allowed.
  void validate() const;
};

/// Settings of the inputs and outputs, beside those of the map. Names are the parameter names;
/// units, ranges and meanings: node_config.cpp and config/default.yaml.
struct NodeConfig : SensorConfig {
  static constexpr std::size_t kMaxSensors = 32;  ///< of one map

  std::string map_frame = "world";                 ///< of map and poses
  PoseSource pose_source = PoseSource::kOdometry;  ///< where poses come from
  std::string body_frame;                          ///< empty: child frame of the poses
  /// Those of a map that has several, in the order of MapperConfig::sensors. Empty: one sensor, as
  /// said here.
  std::vector<SensorConfig> sensors;

  double max_pose_gap = 0.1;   ///< s
  double max_pose_wait = 0.5;  ///< s
  double pose_history = 5.0;   ///< s
  int scan_queue_size = 10;    ///< scans of each sensor
  int ready_queue_size = 2;    ///< scans of each sensor

  double publish_rate = 10.0;     ///< Hz
  double keyframe_period = 10.0;  ///< s
  std::string save_directory;     ///< empty: maps are not saved

  /// All sensors, at least one.
  std::vector<SensorConfig> allSensors() const;

  /// \throws std::invalid_argument that names the parameter, its value and what is allowed.
  void validate() const;
};

/// All parameters of a NodeConfig, bound to `config`, in the order of config/default.yaml.
std::vector<Parameter> nodeParameters(NodeConfig* config);

/// The parameters that each of `sensors` has of its own, under their full names: "front/max_depth".
std::vector<Parameter> sensorParameters(MapperConfig* mapper, NodeConfig* node);

/// Sets and validates both configurations, as the nodelet and the offline tool do. What is not set
/// for one of several sensors is as set for all.
/// \return the names in `values` that no parameter has; of a namespace that is no sensor's, its
/// name.
/// \throws std::invalid_argument that names the parameter, its value and what is allowed.
std::vector<std::string> configure(const ParameterMap& values, MapperConfig* mapper,
                                   NodeConfig* node);

/// Of a map and its node that belong together.
/// \throws std::invalid_argument that names the parameter, its value and what is allowed.
void validate(const MapperConfig& mapper, const NodeConfig& node);

/// What to add for a user when a name that configure() returned lies in a sensor's namespace: which
/// parameters a sensor may have of its own. Empty for other names.
std::string hintForUnknown(const std::string& name);

}  // namespace fiimap
