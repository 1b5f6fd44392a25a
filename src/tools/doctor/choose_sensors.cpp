#include <algorithm>

#include "doctor/scan_candidates.h"
#include "doctor/several_sensors.h"
#include "doctor/topic_choice.h"

namespace fiimap {
namespace {

const std::string kDepthType = "sensor_msgs/Image";
const std::string kPointsType = "sensor_msgs/PointCloud2";

ScanTopics sensorOn(const std::string& topic, const Examination& e) {
  ScanTopics sensor;
  if (e.seen.depth.count(topic) != 0) {
    sensor.depth_image = topic;
    sensor.camera_info = cameraInfoOf(topic, e);
  } else {
    sensor.points = topic;
  }
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
  MapSetup& setup = e->setup;
  static_cast<ScanTopics&>(setup) = sensors.front();
  setup.name.clear();
  setup.sensors = sensors;
  if (setup.node.sensors.empty()) shareSetup(sensors, &setup);
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
  const auto add = [&](const std::string& topic, const std::string& type, const char* option) {
    requireType(topic, {type}, option, e.seen);
    ScanTopics sensor = sensorOn(topic, e);
    if (type == kDepthType) {
      sensor.depth_image = topic;
      sensor.points.clear();
      const std::size_t index = sensors.size();
      if (index < e.wishes.camera_infos.size()) {
        sensor.camera_info = e.wishes.camera_infos[index];
        requireType(sensor.camera_info, {"sensor_msgs/CameraInfo"}, "--camera-info", e.seen);
      }
    }
    sensor.name = nameForSensor(sensor, sensors, e.seen);
    sensors.push_back(sensor);
  };
  for (const std::string& topic : e.wishes.depth_images) add(topic, kDepthType, "--depth-image");
  for (const std::string& topic : e.wishes.points) add(topic, kPointsType, "--points");
  return sensors;
}

/// Gives the sensors that have names already their topics, the surest first.
class TopicAssignment {
 public:
  explicit TopicAssignment(const Examination& e) : e_(e), configs_(e.setup.node.sensors) {
    for (const SensorConfig& config : configs_) {
      sensors_.emplace_back();
      sensors_.back().name = config.name;
      listened_.push_back(listenedBy(config, e.seen));
    }
  }

  std::vector<ScanTopics> assign() {
    each([this](std::size_t i, const std::string& topic) { return topic == listened_[i].scans; });
    each([this](std::size_t i, const std::string& topic) {
      return topic.find(configs_[i].name) != std::string::npos;
    });
    // That of another device; all that are left may be others' where a map runs.
    each([this](std::size_t, const std::string& topic) {
      return reasonToLeaveOut(topic, withTopics(), e_).empty();
    });
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (sensors_[i].scans().empty()) setScans(i, listened_[i].scans);
    }
    return sensors_;
  }

 private:
  std::vector<std::string> candidatesFor(std::size_t i) const {
    const bool has_depth = configs_[i].sensor == SensorKind::kDepth;
    const std::vector<std::string>& wishes = has_depth ? e_.wishes.depth_images : e_.wishes.points;
    if (!wishes.empty()) return wishes;
    return has_depth ? depthImages(e_) : cloudTopics(e_);
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
    ScanTopics& sensor = sensors_[i];
    if (configs_[i].sensor == SensorKind::kPoints) {
      sensor.points = topic;
      return;
    }
    sensor.depth_image = topic;
    const std::string& listened = listened_[i].camera_info;
    sensor.camera_info = e_.seen.infos.count(listened) != 0 ? listened : cameraInfoOf(topic, e_);
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
  std::vector<ListenedTopics> listened_;
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
  std::vector<ScanTopics> sensors = {sensorOn(e->setup.scans(), *e)};
  sensors.front().name = nameForSensor(sensors.front(), {}, e->seen);
  std::vector<std::string> left_out;
  for (const auto& topics : {depthImages(*e), cloudTopics(*e)}) {
    for (const std::string& topic : topics) {
      if (topic == sensors.front().scans()) continue;
      const std::string reason = reasonToLeaveOut(topic, sensors, *e);
      if (!reason.empty() || sensors.size() == NodeConfig::kMaxSensors) {
        left_out.push_back(topic + (reason.empty() ? "" : " (" + reason + ')'));
        continue;
      }
      ScanTopics sensor = sensorOn(topic, *e);
      sensor.name = nameForSensor(sensor, sensors, e->seen);
      sensors.push_back(sensor);
    }
  }
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
