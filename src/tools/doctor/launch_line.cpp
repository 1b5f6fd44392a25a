#include "doctor/launch_line.h"

#include <algorithm>
#include <cctype>

#include "doctor/launch_parameters.h"
#include "doctor/scan_candidates.h"

namespace fiimap {
namespace {

constexpr std::size_t kLineLength = 90;
constexpr const char* kPoseNames[3] = {"odom", "pose", "transform"};
constexpr const char* kSourceNames[4] = {"odometry", "pose", "transform", "tf"};

/// All sensors are LiDARs, and there are no parameters of a map that runs.
bool isForLidarLaunch(const Observation& seen, const MapSetup& setup) {
  const std::vector<ScanTopics> sensors = setup.allSensors();
  return !seen.map && std::all_of(sensors.begin(), sensors.end(), [&](const ScanTopics& sensor) {
    return isLidar(sensor.points, seen);
  });
}

bool needsTf(const NodeConfig& node) {
  const std::vector<SensorConfig> sensors = node.allSensors();
  return node.pose_source == PoseSource::kTf ||
         std::any_of(sensors.begin(), sensors.end(), [](const SensorConfig& sensor) {
           return sensor.extrinsics == ExtrinsicsSource::kTf;
         });
}

/// Those that the map needs; without a recorded /clock, which the player publishes itself.
std::string topicsToPlay(const Observation& seen, const MapSetup& setup) {
  std::string topics;
  const auto add = [&topics](const std::string& topic) {
    if (!topic.empty()) topics += (topics.empty() ? "" : " ") + topic;
  };
  for (const ScanTopics& sensor : setup.allSensors()) {
    add(sensor.scans());
    add(sensor.camera_info);
  }
  add(setup.poses);
  for (const char* topic : {"/tf", "/tf_static"}) {
    if (needsTf(setup.node) && seen.types.count(topic) != 0) add(topic);
  }
  return topics;
}

/// The topics of several sensors, as mapping.launch takes them: "front/points=/points left/..."
std::string topicsOfSensors(const MapSetup& setup) {
  std::string topics;
  for (const ScanTopics& sensor : setup.sensors) {
    const auto add = [&](const char* name, const std::string& topic) {
      if (topic.empty()) return;
      topics += (topics.empty() ? "" : " ") + sensor.name + '/' + name + '=' + topic;
    };
    add("depth/image", sensor.depth_image);
    add("depth/camera_info", sensor.camera_info);
    add("points", sensor.points);
  }
  return topics;
}

std::string quoted(const std::string& word) {
  const std::size_t assign = word.find(":=");
  const std::string value = assign == std::string::npos ? word : word.substr(assign + 2);
  const std::string before = word.substr(0, word.size() - value.size());
  const bool is_plain = std::all_of(value.begin(), value.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string("_/.-+,:=@%").find(static_cast<char>(c)) != std::string::npos;
  });
  if (is_plain && !value.empty()) return word;
  std::string inner;
  for (const char c : value) inner += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return before + '\'' + inner + '\'';
}

}  // namespace

std::vector<std::string> launchWords(const Observation& seen, const MapSetup& setup) {
  const bool lidar = isForLidarLaunch(seen, setup);
  std::vector<std::string> words = {"roslaunch", "fiimap",
                                    lidar         ? "lidar.launch"
                                    : seen.live() ? "mapping.launch"
                                                  : "replay.launch"};
  const auto add = [&words](const std::string& argument, const std::string& value) {
    if (!value.empty()) words.push_back(argument + ":=" + value);
  };
  add("bag", seen.bag);
  if (!seen.live() && seen.types.count("/clock") != 0) {
    add("bag_topics", topicsToPlay(seen, setup));
  }
  if (seen.map) {
    // A node's name has no '/': its namespace is that of the whole launch file.
    const std::size_t slash = seen.map->name.rfind('/');
    add("__ns", seen.map->name.substr(0, slash));
    const std::string name = seen.map->name.substr(slash + 1);
    if (name != "fiimap") add("name", name);
    add("manager", seen.map->manager);
  }
  if (!lidar) add("sensor", setup.node.sensor == SensorKind::kDepth ? "depth" : "points");
  if (setup.sensors.empty()) {
    add("depth_image", setup.depth_image);
    add("camera_info", setup.camera_info);
    add("points", setup.points);
  } else {
    add("topics", topicsOfSensors(setup));
  }
  const auto source = static_cast<std::size_t>(setup.node.pose_source);
  add("pose_source", kSourceNames[source]);
  if (setup.node.pose_source != PoseSource::kTf) add(kPoseNames[source], setup.poses);
  add("map_frame", setup.node.map_frame);
  if (seen.map || setup.changes.count("body_frame") != 0) add("body_frame", setup.node.body_frame);
  add("parameters", toYaml(furtherParameters(seen, setup)));
  return words;
}

std::string shellCommand(const std::vector<std::string>& words) {
  std::string text, line;
  for (const std::string& word : words) {
    const std::string next = quoted(word);
    if (!line.empty() && line.size() + next.size() > kLineLength) {
      text += line + " \\\n";
      line = "   ";
    }
    line += (line.empty() ? "" : " ") + next;
  }
  return text + line;
}

}  // namespace fiimap
