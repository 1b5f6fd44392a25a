#include "fiimap/ros/node_config.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "sensor_parameters.h"

namespace fiimap {
namespace {

constexpr double kMinSeconds = 0.001;
constexpr double kMaxRate = 1000.0;         // Hz
constexpr double kMinKeyframePeriod = 0.1;  // s
constexpr int kMaxQueue = 1000;

[[noreturn]] void refuseConfiguration(const std::string& what) {
  throw std::invalid_argument(what);
}

void requireFrame(const std::string& name, const std::string& frame) {
  if (!frame.empty() && frame.front() == '/') {
    refuseConfiguration("parameter " + name + " = '" + frame + "': must not begin with '/'");
  }
}

std::vector<Parameter> poseParameters(NodeConfig* c) {
  return {
      textParameter("map_frame", &c->map_frame,
                    "frame of the map and of the poses, no leading '/'"),
      choiceParameter("pose_source", &c->pose_source, {"odometry", "pose", "transform", "tf"},
                      "where poses come from: the topics odom, pose, transform, or /tf"),
      textParameter("body_frame", &c->body_frame,
                    "frame whose pose is given; empty: child_frame_id of the pose message"),
      sensorsParameter(&c->sensors),
  };
}

std::vector<Parameter> queueAndOutputParameters(NodeConfig* c) {
  return {
      tunable(numberParameter("max_pose_gap", &c->max_pose_gap, kMinSeconds, kMaxSeconds, "s",
                              "largest time between the two poses around a scan")),
      tunable(numberParameter("max_pose_wait", &c->max_pose_wait, 0.0, kMaxSeconds, "s",
                              "how long a scan waits for its pose")),
      numberParameter("pose_history", &c->pose_history, kMinSeconds, kMaxSeconds, "s",
                      "how long poses and transforms are kept"),
      integerParameter("scan_queue_size", &c->scan_queue_size, 1, kMaxQueue, "scans",
                       "how many scans may wait for their pose"),
      integerParameter("ready_queue_size", &c->ready_queue_size, 1, kMaxQueue, "scans",
                       "how many scans with pose may wait for the map; the newest win"),

      tunable(numberParameter("publish_rate", &c->publish_rate, kMinSeconds, kMaxRate, "Hz",
                              "clouds and changes are published at most this often")),
      numberParameter("keyframe_period", &c->keyframe_period, kMinKeyframePeriod, kMaxSeconds, "s",
                      "time between whole maps on ~changes"),
      textParameter("save_directory", &c->save_directory,
                    "where ~save_map writes and ~load_map reads; empty: they refuse"),
  };
}

void append(std::vector<Parameter> more, std::vector<Parameter>* all) {
  std::move(more.begin(), more.end(), std::back_inserter(*all));
}

bool isNameOf(const std::string& name, const std::vector<Parameter>& parameters) {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&name](const Parameter& parameter) { return parameter.name == name; });
}

/// What lies under a sensor's name cannot lie under a parameter's.
void requireFreeNames(const std::vector<SensorConfig>& sensors,
                      const std::vector<Parameter>& parameters) {
  for (const SensorConfig& sensor : sensors) {
    if (!isNameOf(sensor.name, parameters)) continue;
    refuseConfiguration("parameter sensors = '" + joinNames(sensors) + "': '" + sensor.name +
                        "' is the name of a parameter, must be another");
  }
}

/// Gives each sensor what is set for all.
void shareAmongSensors(MapperConfig* mapper, NodeConfig* node) {
  for (SensorConfig& sensor : node->sensors) {
    std::string name = std::move(sensor.name);
    sensor = *node;
    sensor.name = std::move(name);
  }
  mapper->sensors.assign(node->sensors.size(), *mapper);
}

/// \return the names that no parameter has, as configure() does.
std::vector<std::string> configureSensors(const ParameterMap& values, MapperConfig* mapper,
                                          NodeConfig* node) {
  std::vector<std::string> unknown;
  for (std::string& name : applyParameters(values, sensorParameters(mapper, node))) {
    const std::string space = name.substr(0, name.find('/'));
    const bool is_sensor =
        std::any_of(node->sensors.begin(), node->sensors.end(),
                    [&space](const SensorConfig& sensor) { return sensor.name == space; });
    if (!is_sensor) name = space;
    if (unknown.empty() || unknown.back() != name) unknown.push_back(name);
  }
  return unknown;
}

}  // namespace

std::vector<SensorConfig> NodeConfig::allSensors() const {
  return sensors.empty() ? std::vector<SensorConfig>{*this} : sensors;
}

std::vector<Parameter> nodeParameters(NodeConfig* c) {
  std::vector<Parameter> all = poseParameters(c);
  append(parametersOfSensor(c, ""), &all);
  append(queueAndOutputParameters(c), &all);
  return all;
}

std::vector<Parameter> sensorParameters(MapperConfig* mapper, NodeConfig* node) {
  std::vector<Parameter> all;
  for (std::size_t i = 0; i < node->sensors.size(); ++i) {
    const std::string prefix = node->sensors[i].prefix();
    append(parametersOfSensor(&node->sensors[i], prefix), &all);
    append(readingParameters(&mapper->sensors[i], prefix), &all);
  }
  return all;
}

void NodeConfig::validate() const {
  NodeConfig copy = *this;
  for (const Parameter& parameter : nodeParameters(&copy)) parameter.set(parameter.get());

  if (map_frame.empty()) refuseConfiguration("parameter map_frame = '': must name a frame");
  requireFrame("map_frame", map_frame);
  requireFrame("body_frame", body_frame);
  for (const SensorConfig& each : allSensors()) each.validate();
  if (pose_history < max_pose_wait || pose_history < max_pose_gap) {
    refuseConfiguration("parameter pose_history = " + std::to_string(pose_history) +
                        ": must be at least max_pose_wait and max_pose_gap");
  }
  if (!body_frame.empty()) return;
  if (pose_source == PoseSource::kTf && sensors.size() > 1) {
    refuseConfiguration(
        "parameter body_frame = '': must be set, because with several sensors pose_source = tf "
        "needs to know which frame is the vehicle's");
  }
  for (const SensorConfig& each : allSensors()) {
    const bool from_tf = each.extrinsics == ExtrinsicsSource::kTf;
    if (pose_source == PoseSource::kPose && from_tf) {
      refuseConfiguration(
          "parameter body_frame = '': must be set, because " + each.prefix() +
          "extrinsics = tf and the messages of pose_source = pose do not name their body");
    }
    if (pose_source == PoseSource::kTf && !from_tf) {
      refuseConfiguration(
          "parameter body_frame = '': must be set, because " + each.prefix() +
          "extrinsics = parameter starts from the body and pose_source = tf needs its name");
    }
  }
}

std::vector<std::string> configure(const ParameterMap& values, MapperConfig* mapper,
                                   NodeConfig* node) {
  std::vector<Parameter> parameters = mapperParameters(mapper);
  append(nodeParameters(node), &parameters);
  ParameterMap of_all, of_sensors;
  for (const auto& [name, value] : values) {
    const std::string space = name.substr(0, name.find('/'));
    if (space == name) {
      of_all[name] = value;
    } else if (isNameOf(space, parameters)) {
      of_all[space] = "";  // a namespace is no value of a parameter
    } else {
      of_sensors[name] = value;
    }
  }
  std::vector<std::string> unknown = applyParameters(of_all, parameters);
  requireFreeNames(node->sensors, parameters);
  shareAmongSensors(mapper, node);
  for (std::string& name : configureSensors(of_sensors, mapper, node)) unknown.push_back(name);
  validate(*mapper, *node);
  return unknown;
}

void validate(const MapperConfig& mapper, const NodeConfig& node) {
  // First, because they name the sensor.
  for (std::size_t i = 0; i < node.sensors.size(); ++i) {
    mapper.sensors[i].validate(node.sensors[i].prefix());
  }
  mapper.validate();
  node.validate();
}

std::string hintForUnknown(const std::string& name) {
  if (name.find('/') == std::string::npos) return "";
  MapperConfig mapper;
  NodeConfig node;
  std::string names;
  for (const auto& list : {parametersOfSensor(&node, ""), readingParameters(&mapper)}) {
    for (const Parameter& parameter : list) names += (names.empty() ? "" : ", ") + parameter.name;
  }
  return "; a sensor may have of its own: " + names;
}

}  // namespace fiimap
