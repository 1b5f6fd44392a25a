#include <algorithm>

#include "doctor/checks.h"
#include "doctor/several_sensors.h"
#include "doctor/topic_choice.h"

namespace fiimap {
namespace {

/// What a map listens to must be what was found.
void checkInput(const std::string& what, const std::string& type, const std::string& found,
                const char* argument, Examination* e) {
  const std::string listened = listenedTo(type, e->seen, {found});
  if (listened.empty() || found.empty() || listened == found) return;
  const bool exists = e->seen.types.count(listened) != 0;
  e->error("The map " + e->seen.map->name + " listens to " + listened + " for " + what + ", " +
               (exists ? "where nothing fit came" : "which nobody publishes") +
               "; found: " + found + ".",
           std::string("Start it with ") + argument + ":=" + found + ".", Repair::kInLaunchLine);
}

/// The same of a topic of one of its sensors.
void checkSensorInput(const ScanTopics& sensor, const std::string& listened,
                      const std::string& found, const std::string& topic, Examination* e) {
  if (found.empty() || listened == found) return;
  const bool exists = e->seen.types.count(listened) != 0;
  e->error(
      "The map " + e->seen.map->name +
          (listened.empty() ? " does not listen to " + found
                            : " listens to " + listened + ", " +
                                  (exists ? "where nothing fit came" : "which nobody publishes")) +
          ", for its sensor '" + sensor.name +
          (listened.empty() ? "'." : "'; found: " + found + "."),
      "Start it with " + sensor.name + '/' + topic + "=" + found +
          " in topics:=, as the launch line does.",
      Repair::kInLaunchLine);
}

void checkSensorInputs(Examination* e) {
  const MapSetup& setup = e->setup;
  for (std::size_t i = 0; i < setup.sensors.size(); ++i) {
    const ScanTopics& sensor = setup.sensors[i];
    const ListenedTopics listened = listenedBy(setup.node.sensors[i], e->seen);
    const bool has_depth = sensor.points.empty();
    checkSensorInput(sensor, listened.scans, sensor.scans(), has_depth ? "depth/image" : "points",
                     e);
    checkSensorInput(sensor, listened.camera_info, sensor.camera_info, "depth/camera_info", e);
  }
}

/// What a map complains of is most likely what was found before, and goes with it.
Repair repairOfAll(const std::vector<Finding>& findings) {
  std::vector<Repair> repairs;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::kError) repairs.push_back(finding.repair);
  }
  return repairs.empty() ? Repair::kNone : *std::min_element(repairs.begin(), repairs.end());
}

}  // namespace

void checkRunningMap(Examination* e) {
  if (!e->seen.map) return;
  const RunningMap& map = *e->seen.map;
  const MapSetup& setup = e->setup;
  e->note("A map runs: " + map.name + "; its parameters and topics were looked at.");
  if (!setup.sensors.empty()) {
    checkSensorInputs(e);
  } else {
    checkInput("depth images", kImageType, setup.depth_image, "depth_image", e);
    checkInput("camera_info", kCameraInfoType, setup.camera_info, "camera_info", e);
    checkInput("clouds", kCloudType, setup.points, "points", e);
  }
  constexpr const char* kArguments[3] = {"odom", "pose", "transform"};
  if (setup.node.pose_source != PoseSource::kTf) {
    const auto source = static_cast<std::size_t>(setup.node.pose_source);
    checkInput("poses", kPoseTypes[source], setup.poses, kArguments[source], e);
  }
  const auto source = map.parameters.find("pose_source");
  NodeConfig now;
  if (source != map.parameters.end()) {
    applyParameters({{"pose_source", source->second}}, nodeParameters(&now));
  }
  if (setup.has_poses && now.pose_source != setup.node.pose_source) {
    e->error("The map " + map.name + " takes its poses from another source than there is.",
             "Start it as the launch line does.", Repair::kInLaunchLine);
  }
  const std::string where = "It is said on /diagnostics; README.md, Questions, has more.";
  const Repair repair = repairOfAll(e->findings);
  for (const std::string& text : map.errors) {
    e->error("The map " + map.name + " says: " + text + ".", where, repair);
  }
  for (const std::string& text : map.warnings) {
    e->warn("The map " + map.name + " says: " + text + ".", where);
  }
}

}  // namespace fiimap
