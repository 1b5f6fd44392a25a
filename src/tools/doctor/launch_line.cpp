#include "doctor/launch_line.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

#include "quantiles.h"

namespace fiimap {
namespace {

constexpr double kCameraRange = 10.0;  // m; what sees farther is a LiDAR
constexpr std::size_t kLineLength = 90;
constexpr const char* kPoseNames[3] = {"odom", "pose", "transform"};
constexpr const char* kSourceNames[4] = {"odometry", "pose", "transform", "tf"};

bool isLidar(const Observation& seen, const MapSetup& setup) {
  const auto points = seen.points.find(setup.points);
  return points != seen.points.end() && !points->second.is_organised &&
         quantilesOf(points->second.ranges).p95 > kCameraRange;
}

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

bool isWord(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.';
  });
}

bool isList(const std::string& parameter) {
  return parameter == "extrinsic_translation" || parameter == "extrinsic_rotation" ||
         parameter == "sensors";
}

/// A parameter's text as a value in YAML; in lists, words are separated by spaces.
std::string yamlValue(const std::string& parameter, const std::string& text) {
  if (!isList(parameter)) return isNumber(text) || isWord(text) ? text : '"' + text + '"';
  std::istringstream words(text);
  std::string list;
  for (std::string word; words >> word;) list += (list.empty() ? "" : ", ") + word;
  return '[' + list + ']';
}

/// "{a: 1, b: [1, 2]}"; empty where there is nothing to set.
std::string furtherParameters(const ParameterMap& changes) {
  std::string yaml;
  for (const auto& [name, value] : changes) {
    const bool has_argument =
        name == "sensor" || name == "pose_source" || name == "map_frame" || name == "body_frame";
    if (!has_argument) yaml += (yaml.empty() ? "" : ", ") + name + ": " + yamlValue(name, value);
  }
  return yaml.empty() ? "" : '{' + yaml + '}';
}

/// Those that the map needs; without a recorded /clock, which the player publishes itself.
std::string topicsToPlay(const Observation& seen, const MapSetup& setup) {
  const bool needs_tf =
      setup.node.pose_source == PoseSource::kTf || setup.node.extrinsics == ExtrinsicsSource::kTf;
  std::string topics = setup.scans();
  for (const std::string& topic : {setup.camera_info, setup.poses}) {
    if (!topic.empty()) topics += ' ' + topic;
  }
  for (const char* topic : {"/tf", "/tf_static"}) {
    if (needs_tf && seen.types.count(topic) != 0) topics += std::string(" ") + topic;
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
  const bool lidar = isLidar(seen, setup);
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
  if (seen.map && seen.map->name != "/fiimap") add("name", seen.map->name.substr(1));
  if (!lidar) add("sensor", setup.node.sensor == SensorKind::kDepth ? "depth" : "points");
  add("depth_image", setup.depth_image);
  add("camera_info", setup.camera_info);
  add("points", setup.points);
  const auto source = static_cast<std::size_t>(setup.node.pose_source);
  add("pose_source", kSourceNames[source]);
  if (setup.node.pose_source != PoseSource::kTf) add(kPoseNames[source], setup.poses);
  add("map_frame", setup.node.map_frame);
  if (setup.changes.count("body_frame") != 0) add("body_frame", setup.node.body_frame);
  add("parameters", furtherParameters(setup.changes));
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
