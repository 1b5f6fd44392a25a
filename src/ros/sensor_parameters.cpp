#include "sensor_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <set>
#include <sstream>
#include <stdexcept>

namespace fiimap {
namespace {

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

/// A list as on command lines, "[1, 2, 3]", as "1 2 3".
std::string withoutBrackets(std::string text) {
  for (const char separator : {'[', ',', ']'}) {
    std::replace(text.begin(), text.end(), separator, ' ');
  }
  return text;
}

/// A list of as many numbers as `field` has.
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
            std::istringstream stream(withoutBrackets(text));
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

/// The base name of a ROS graph name.
bool isGraphName(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_inside = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), is_inside);
}

}  // namespace

std::string joinNames(const std::vector<SensorConfig>& sensors) {
  std::string text;
  for (const SensorConfig& sensor : sensors) text += (text.empty() ? "" : " ") + sensor.name;
  return text;
}

Parameter sensorsParameter(std::vector<SensorConfig>* field) {
  const std::string name = "sensors";
  const std::string allowed = "a list of at most " + std::to_string(NodeConfig::kMaxSensors) +
                              " different names of letters, digits and _, each with a letter first";
  return {name,
          "",
          allowed,
          "names of the sensors of a map that has several; empty: one, without a name",
          [field] { return joinNames(*field); },
          [name, field, allowed](const std::string& text) {
            std::istringstream words(withoutBrackets(text));
            std::vector<SensorConfig> sensors;
            std::set<std::string> names;
            for (SensorConfig sensor; words >> sensor.name; sensors.push_back(sensor)) {
              const bool is_new = names.insert(sensor.name).second;
              if (is_new && isGraphName(sensor.name)) continue;
              refuse("parameter " + name + " = '" + text + "': '" + sensor.name +
                     (is_new ? "' is no name: must be " : "' stands there twice: must be ") +
                     allowed);
            }
            if (sensors.size() > NodeConfig::kMaxSensors) {
              refuse("parameter " + name + " = '" + text + "': must be " + allowed);
            }
            *field = sensors;
          }};
}

std::vector<Parameter> parametersOfSensor(SensorConfig* c, const std::string& prefix) {
  return {
      choiceParameter(prefix + "sensor", &c->sensor, {"depth", "points"},
                      "depth: depth/image with depth/camera_info; points: points"),
      choiceParameter(prefix + "extrinsics", &c->extrinsics, {"tf", "parameter"},
                      "where the sensor's place on the body comes from"),
      vectorParameter(prefix + "extrinsic_translation", &c->extrinsic_translation, "m",
                      "x y z of the sensor in the body frame"),
      vectorParameter(prefix + "extrinsic_rotation", &c->extrinsic_rotation, "",
                      "quaternion x y z w that rotates from sensor to body frame"),
      tunable(numberParameter(prefix + "time_offset", &c->time_offset, -kMaxSeconds, kMaxSeconds,
                              "s", "added to the stamps of the sensor")),
  };
}

Eigen::Isometry3d SensorConfig::parameterExtrinsics() const {
  const Eigen::Vector4d& q = extrinsic_rotation;
  Eigen::Isometry3d T_B_S = Eigen::Isometry3d::Identity();
  T_B_S.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  T_B_S.translation() = extrinsic_translation;
  return T_B_S;
}

void SensorConfig::validate() const {
  SensorConfig copy = *this;
  for (const Parameter& parameter : parametersOfSensor(&copy, prefix())) {
    parameter.set(parameter.get());
  }
  if (std::abs(extrinsic_rotation.norm() - 1.0) > kNormTolerance) {
    refuse("parameter " + prefix() + "extrinsic_rotation = '" + joinNumbers(extrinsic_rotation) +
           "': must be a quaternion x y z w of norm 1");
  }
}

}  // namespace fiimap
