#include "fiimap/ros/node_config.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace fiimap {
namespace {

constexpr double kMaxSeconds = 3600.0;
constexpr double kMinSeconds = 0.001;
constexpr double kMaxRate = 1000.0;  // Hz
constexpr int kMaxQueue = 1000;
constexpr double kNormTolerance = 0.01;  // of extrinsic_rotation, for values rounded to two digits

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

template <typename Vector>
std::string joinNumbers(const Vector& vector) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::digits10);
  for (int i = 0; i < vector.size(); ++i) text << (i > 0 ? " " : "") << vector[i];
  return text.str();
}

/// A list of as many numbers as `field` has: "1 2 3", or as on command lines "[1, 2, 3]".
template <typename Vector>
Parameter vectorParameter(const std::string& name, Vector* field, const std::string& unit,
                          const std::string& meaning) {
  const std::string allowed = "a list of " + std::to_string(field->size()) + " finite numbers";
  return {name,
          unit,
          allowed,
          meaning,
          [field] { return joinNumbers(*field); },
          [name, field, allowed](const std::string& text) {
            std::string numbers = text;
            for (const char separator : {'[', ',', ']'}) {
              std::replace(numbers.begin(), numbers.end(), separator, ' ');
            }
            std::istringstream stream(numbers);
            stream.imbue(std::locale::classic());
            Vector vector;
            for (int i = 0; i < vector.size(); ++i) stream >> vector[i];
            const bool complete = !stream.fail() && (stream >> std::ws).eof();
            if (!complete || !vector.allFinite()) {
              refuse("parameter " + name + " = '" + text + "': must be " + allowed);
            }
            *field = vector;
          }};
}

void requireFrame(const std::string& name, const std::string& frame) {
  if (!frame.empty() && frame.front() == '/') {
    refuse("parameter " + name + " = '" + frame + "': must not begin with '/'");
  }
}

}  // namespace

Eigen::Isometry3d NodeConfig::parameterExtrinsics() const {
  const Eigen::Vector4d& q = extrinsic_rotation;
  Eigen::Isometry3d T_B_S = Eigen::Isometry3d::Identity();
  T_B_S.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  T_B_S.translation() = extrinsic_translation;
  return T_B_S;
}

std::vector<Parameter> nodeParameters(NodeConfig* c) {
  return {
      textParameter("map_frame", &c->map_frame,
                    "frame of the map and of the poses, no leading '/'"),
      choiceParameter("sensor", &c->sensor, {"depth", "points"},
                      "depth: depth/image with depth/camera_info; points: points"),
      choiceParameter("pose_source", &c->pose_source, {"odometry", "pose", "transform", "tf"},
                      "where poses come from: the topics odom, pose, transform, or /tf"),
      textParameter("body_frame", &c->body_frame,
                    "frame whose pose is given; empty: child_frame_id of the pose message"),
      choiceParameter("extrinsics", &c->extrinsics, {"tf", "parameter"},
                      "where the sensor's place on the body comes from"),
      vectorParameter("extrinsic_translation", &c->extrinsic_translation, "m",
                      "x y z of the sensor in the body frame"),
      vectorParameter("extrinsic_rotation", &c->extrinsic_rotation, "",
                      "quaternion x y z w that rotates from sensor to body frame"),

      numberParameter("time_offset", &c->time_offset, -kMaxSeconds, kMaxSeconds, "s",
                      "added to the stamps of the sensor"),
      numberParameter("max_pose_gap", &c->max_pose_gap, kMinSeconds, kMaxSeconds, "s",
                      "largest time between the two poses around a scan"),
      numberParameter("max_pose_wait", &c->max_pose_wait, 0.0, kMaxSeconds, "s",
                      "how long a scan waits for its pose"),
      numberParameter("pose_history", &c->pose_history, kMinSeconds, kMaxSeconds, "s",
                      "how long poses and transforms are kept"),
      integerParameter("scan_queue_size", &c->scan_queue_size, 1, kMaxQueue, "scans",
                       "how many scans may wait for their pose"),
      integerParameter("ready_queue_size", &c->ready_queue_size, 1, kMaxQueue, "scans",
                       "how many scans with pose may wait for the map; the newest win"),

      numberParameter("publish_rate", &c->publish_rate, kMinSeconds, kMaxRate, "Hz",
                      "clouds are published at most this often"),
      textParameter("save_directory", &c->save_directory,
                    "where ~save_map writes; empty: it refuses"),
  };
}

void NodeConfig::validate() const {
  NodeConfig copy = *this;
  for (const Parameter& parameter : nodeParameters(&copy)) parameter.set(parameter.get());

  if (map_frame.empty()) refuse("parameter map_frame = '': must name a frame");
  requireFrame("map_frame", map_frame);
  requireFrame("body_frame", body_frame);
  if (std::abs(extrinsic_rotation.norm() - 1.0) > kNormTolerance) {
    refuse("parameter extrinsic_rotation = '" + joinNumbers(extrinsic_rotation) +
           "': must be a quaternion x y z w of norm 1");
  }
  if (pose_history < max_pose_wait || pose_history < max_pose_gap) {
    refuse("parameter pose_history = " + std::to_string(pose_history) +
           ": must be at least max_pose_wait and max_pose_gap");
  }
  const bool from_tf = extrinsics == ExtrinsicsSource::kTf;
  if (body_frame.empty() && pose_source == PoseSource::kPose && from_tf) {
    refuse(
        "parameter body_frame = '': must be set, because extrinsics = tf and the messages of "
        "pose_source = pose do not name their body");
  }
  if (body_frame.empty() && pose_source == PoseSource::kTf && !from_tf) {
    refuse(
        "parameter body_frame = '': must be set, because extrinsics = parameter starts from the "
        "body and pose_source = tf needs its name");
  }
}

std::vector<std::string> configure(const ParameterMap& values, MapperConfig* mapper,
                                   NodeConfig* node) {
  std::vector<Parameter> parameters = mapperParameters(mapper);
  for (Parameter& parameter : nodeParameters(node)) parameters.push_back(std::move(parameter));
  std::vector<std::string> unknown = applyParameters(values, parameters);
  mapper->validate();
  node->validate();
  return unknown;
}

}  // namespace fiimap
