#include <algorithm>
#include <stdexcept>

#include "doctor/scan_candidates.h"
#include "doctor/several_sensors.h"

namespace fiimap {
namespace {

ScanTopics sensorOn(const std::string& topic, SensorKind kind) {
  ScanTopics sensor;
  (kind == SensorKind::kDepth ? sensor.depth_image : sensor.points) = topic;
  return sensor;
}

std::string quotedName(const ScanTopics& sensor) {
  return '\'' + sensor.name + "' (" + (sensor.points.empty() ? "depth images" : "clouds") + " on " +
         (sensor.scans().empty() ? "no topic" : sensor.scans()) + ')';
}

/// Sets up several sensors that nobody gave parameters: each has those that are set for all.
void shareSetup(const std::vector<ScanTopics>& sensors, MapSetup* setup) {
  std::vector<SensorConfig> configs;
  for (const ScanTopics& sensor : sensors) {
    SensorConfig config = setup->node;
    config.name = sensor.name;
    config.sensor = sensor.depth_image.empty() ? SensorKind::kPoints : SensorKind::kDepth;
    configs.push_back(config);
  }
  setup->node.sensor = configs.front().sensor;
  setup->node.sensors = configs;
  setup->mapper.sensors.assign(sensors.size(), setup->mapper);
}

void useSensors(const std::vector<ScanTopics>& sensors, Examination* e) {
  e->setup.setSensors(sensors);
  if (e->setup.node.sensors.empty()) shareSetup(sensors, &e->setup);
  std::vector<std::string> names;
  for (const ScanTopics& sensor : sensors) names.push_back(quotedName(sensor));
  e->note(
      "One map is made of " + std::to_string(sensors.size()) + " sensors: " + listOf(names) + ".",
      "For others name their topics: --depth-image TOPIC and --points TOPIC, each as often as "
      "needed.");
}

/// Those whose topics the user named.
std::vector<ScanTopics> sensorsOfWishes(const Examination& e) {
  std::vector<ScanTopics> sensors;
  const auto add = [&](const std::string& topic, SensorKind kind) {
    ScanTopics sensor = sensorOn(topic, kind);
    sensor.name = nameForSensor(sensor, sensors, e.seen);
    sensors.push_back(sensor);
  };
  for (const std::string& topic : e.wishes.depth_images) add(topic, SensorKind::kDepth);
  for (const std::string& topic : e.wishes.points) add(topic, SensorKind::kPoints);
  return sensors;
}

/// Gives the sensors that have names already their topics, the surest first.
class TopicAssignment {
 public:
  explicit TopicAssignment(const Examination& e) : e_(e), configs_(e.setup.node.sensors) {
    for (const SensorConfig& config : configs_) {
      sensors_.emplace_back();
      sensors_.back().name = config.name;
      listened_.push_back(listenedBy(config, e.seen).scans);
    }
  }

  /// \throws std::invalid_argument when the user named more topics than there are sensors.
  std::vector<ScanTopics> assign() {
    requireRoom(SensorKind::kDepth, "--depth-image");
    requireRoom(SensorKind::kPoints, "--points");
    each([this](std::size_t i, const std::string& topic) { return topic == listened_[i]; });
    each([this](std::size_t i, const std::string& topic) {
      return topic.find(configs_[i].name) != std::string::npos;
    });
    // One that the user named, or of another device; all that are left may be others' where a map
    // runs.
    each([this](std::size_t i, const std::string& topic) {
      return !named(configs_[i].sensor).empty() ||
             reasonToLeaveOut(topic, withTopics(), e_).empty();
    });
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (sensors_[i].scans().empty()) setScans(i, listened_[i]);
    }
    return sensors_;
  }

 private:
  const std::vector<std::string>& named(SensorKind kind) const {
    return kind == SensorKind::kDepth ? e_.wishes.depth_images : e_.wishes.points;
  }

  void requireRoom(SensorKind kind, const std::string& option) const {
    std::vector<std::string> takers;
    for (const SensorConfig& config : configs_) {
      if (config.sensor == kind) takers.push_back(config.name);
    }
    if (named(kind).size() <= takers.size()) return;
    throw std::invalid_argument(
        option + " names " + listOf(named(kind)) +
        ", more than the sensors that take it: " + (takers.empty() ? "none" : listOf(takers)) +
        "; choose others with --set sensors=... and --set NAME/sensor=...");
  }

  std::vector<std::string> candidatesFor(std::size_t i) const {
    const SensorKind kind = configs_[i].sensor;
    if (!named(kind).empty()) return named(kind);
    return kind == SensorKind::kDepth ? depthImages(e_) : cloudTopics(e_);
  }

  template <typename Fits>
  void each(Fits fits) {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (!sensors_[i].scans().empty()) continue;
      for (const std::string& topic : candidatesFor(i)) {
        if (isTaken(topic) || !fits(i, topic)) continue;
        setScans(i, topic);
        break;
      }
    }
  }

  void setScans(std::size_t i, const std::string& topic) {
    const std::string name = sensors_[i].name;
    sensors_[i] = sensorOn(topic, configs_[i].sensor);
    sensors_[i].name = name;
  }

  bool isTaken(const std::string& topic) const {
    return std::any_of(sensors_.begin(), sensors_.end(),
                       [&topic](const ScanTopics& other) { return other.scans() == topic; });
  }

  std::vector<ScanTopics> withTopics() const {
    std::vector<ScanTopics> all;
    std::copy_if(sensors_.begin(), sensors_.end(), std::back_inserter(all),
                 [](const ScanTopics& sensor) { return !sensor.scans().empty(); });
    return all;
  }

  const Examination& e_;
  const std::vector<SensorConfig> configs_;
  std::vector<std::string> listened_;  // scans
  std::vector<ScanTopics> sensors_;
};

}  // namespace

bool chooseNamedSensors(Examination* e) {
  if (!e->setup.node.sensors.empty()) {
    useSensors(TopicAssignment(*e).assign(), e);
    return true;
  }
  if (e->wishes.depth_images.size() + e->wishes.points.size() < 2) return false;
  useSensors(sensorsOfWishes(*e), e);
  return true;
}

bool chooseAllSensors(Examination* e) {
  std::vector<ScanTopics> sensors = {e->setup};
  sensors.front().name = nameForSensor(sensors.front(), {}, e->seen);
  std::vector<std::string> left_out;
  const auto add = [&](const std::vector<std::string>& topics, SensorKind kind) {
    for (const std::string& topic : topics) {
      if (topic == sensors.front().scans()) continue;
      std::string reason = reasonToLeaveOut(topic, sensors, *e);
      if (reason.empty() && sensors.size() == NodeConfig::kMaxSensors) {
        reason =
            "is beyond the " + std::to_string(NodeConfig::kMaxSensors) + " that a map can have";
      }
      if (!reason.empty()) {
        left_out.push_back(topic + " (" + reason + ')');
        continue;
      }
      ScanTopics sensor = sensorOn(topic, kind);
      sensor.name = nameForSensor(sensor, sensors, e->seen);
      sensors.push_back(sensor);
    }
  };
  add(depthImages(*e), SensorKind::kDepth);
  add(cloudTopics(*e), SensorKind::kPoints);
  if (sensors.size() == 1) return false;
  useSensors(sensors, e);
  if (!left_out.empty()) e->note("Not taken for sensors: " + listOf(left_out) + ".");
  return true;
}

ListenedTopics listenedBy(const SensorConfig& sensor, const Observation& seen) {
  if (!seen.map) return {};
  const auto said = seen.map->sensors.find(sensor.name);
  if (said != seen.map->sensors.end()) return said->second;
  const std::string space = seen.map->name.substr(0, seen.map->name.rfind('/') + 1);
  const auto named = [&](const std::string& topic) {
    const std::string name = space + sensor.prefix() + topic;
    return seen.map->inputs.count(name) != 0 ? name : "";
  };
  if (sensor.sensor == SensorKind::kPoints) return {named("points"), ""};
  return {named("depth/image"), named("depth/camera_info")};
}

}  // namespace fiimap
