#include <algorithm>
#include <stdexcept>

#include "doctor/checks.h"
#include "doctor/topic_choice.h"
#include "fiimap/ros/frame_id.h"

namespace fiimap {
namespace {

constexpr double kUsefulRate = 10.0;  // Hz

/// Where a vehicle should be, not where it is.
bool isTarget(const std::string& topic) {
  for (const char* word : {"setpoint", "goal", "target", "command", "reference", "desired"}) {
    if (topic.find(word) != std::string::npos) return true;
  }
  return false;
}

/// From a receiver of GPS, alone or fused: MAVROS's global_position/local, robot_localization's
/// odometry/gps and odometry/global.
bool isGlobal(const std::string& topic) {
  for (const char* word : {"global", "gps", "gnss"}) {
    if (topic.find(word) != std::string::npos) return true;
  }
  return false;
}

/// Poses that the map does not read.
std::vector<std::string> foreignPoses(const Observation& seen) {
  std::vector<std::string> topics;
  for (const char* type : {"geometry_msgs/PoseWithCovarianceStamped", "geometry_msgs/Pose",
                           "geometry_msgs/Transform", "nav_msgs/Path"}) {
    for (const std::string& topic : topicsOfType(type, seen)) {
      if (!isOutputOfMap(topic, seen)) topics.push_back(topic + " (" + type + ")");
    }
  }
  return topics;
}

int likelihoodOfPoses(const std::string& topic, const Examination& e) {
  const auto& poses = e.seen.poses.at(topic);
  const std::string body = plainFrame(poses.front().message->child_frame_id);
  const std::vector<std::string> sensors = e.sensorFrames();
  const bool leads_to_sensor =
      std::any_of(sensors.begin(), sensors.end(),
                  [&](const std::string& sensor) { return e.frames.areConnected(body, sensor); });
  const bool is_fast = static_cast<double>(poses.size()) >= kUsefulRate * e.seen.seconds;
  return 4 * static_cast<int>(leads_to_sensor) + 2 * static_cast<int>(!isGlobal(topic)) +
         static_cast<int>(is_fast);
}

std::vector<std::string> poseTopics(const std::string& type, const Examination& e) {
  std::vector<std::string> topics;
  for (const auto& [topic, poses] : e.seen.poses) {
    const bool is_candidate =
        e.seen.types.at(topic) == type && !isTarget(topic) && !isOutputOfMap(topic, e.seen);
    if (is_candidate) topics.push_back(topic);
  }
  std::stable_sort(topics.begin(), topics.end(), [&e](const auto& a, const auto& b) {
    return likelihoodOfPoses(a, e) > likelihoodOfPoses(b, e);
  });
  return topics;
}

void reportSilence(const std::string& topic, Examination* e) {
  e->error("There are no poses: no message came on " + topic + " in " +
               withUnit(e->seen.seconds, "s", 1) + ", although it is advertised.",
           "Look at its publisher: an estimator of poses may wait for its sensors, or for motion.");
}

void usePoses(PoseSource source, const std::string& topic, Examination* e) {
  e->setup.node.pose_source = source;
  e->setup.poses = topic;
  e->setup.has_poses = true;
}

constexpr const char* kOptions[3] = {"--odom", "--pose", "--transform"};

/// \return whether the user named the poses.
bool useWish(Examination* e) {
  const DoctorWishes& wishes = e->wishes;
  const std::string named[3] = {wishes.odom, wishes.pose, wishes.transform};
  for (int i = 0; i < 3; ++i) {
    if (named[i].empty()) continue;
    requireType(named[i], {kPoseTypes[i]}, kOptions[i], e->seen);
    if (e->seen.poses.count(named[i]) == 0) {
      reportSilence(named[i], e);
    } else {
      usePoses(static_cast<PoseSource>(i), named[i], e);
    }
    return true;
  }
  return false;
}

/// Says why local poses are better, where there are both.
void judgeGlobalPoses(const std::string& chosen, Examination* e) {
  std::vector<std::string> others;
  for (const char* type : kPoseTypes) {
    for (const std::string& topic : poseTopics(type, *e)) {
      if (isGlobal(topic) != isGlobal(chosen)) others.push_back(topic);
    }
  }
  if (others.empty()) return;
  const std::string reason =
      "global poses follow GPS, which jumps by decimetres and more when it corrects itself, and "
      "walls double then; local ones drift slowly instead";
  if (!isGlobal(chosen)) {
    e->note("Poses are taken from " + chosen + ", not from " + listOf(others) + ": " + reason +
            ".");
  } else {
    e->warn("Poses are taken from " + chosen + ", although there is " + listOf(others) + ": " +
                reason + ".",
            "Take the local ones.");
  }
}

/// \return whether there is a topic of a source that is no TF.
bool useTopic(PoseSource source, bool only_local, Examination* e) {
  const auto index = static_cast<std::size_t>(source);
  const std::vector<std::string> topics = poseTopics(kPoseTypes[index], *e);
  if (topics.empty()) return false;
  const std::string listened = listenedTo(kPoseTypes[index], e->seen, topics);
  const std::string chosen = e->seen.poses.count(listened) != 0 ? listened : topics.front();
  if (only_local && isGlobal(chosen) && chosen != listened) return false;
  noteOthers("topics of poses", chosen, topics, kOptions[index], e);
  usePoses(source, chosen, e);
  judgeGlobalPoses(chosen, e);
  return true;
}

bool isNameOfWorld(const std::string& frame) {
  for (const char* name : {"odom", "map", "world", "earth", "camera_init"}) {
    if (frame == name) return true;
  }
  return false;
}

/// The frame above the highest link that moves, seen from the sensor; "odom" goes before "map": it
/// does not jump. Where nothing moves, the first frame with the name of a world.
std::string worldAbove(const std::string& sensor_frame, const FrameGraph& frames) {
  const std::vector<std::string> chain = frames.chainToRoot(sensor_frame);
  std::string world;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    if (chain[i] != "odom" && frames.moves(chain[i])) world = chain[i + 1];
  }
  if (!world.empty()) return world;
  const auto named = std::find_if(chain.begin(), chain.end(), isNameOfWorld);
  return named == chain.end() ? "" : *named;
}

/// \return whether TF has poses of a sensor.
bool useTf(Examination* e) {
  for (const std::string& sensor : e->sensorFrames()) {
    const std::string world =
        e->isGiven("map_frame") ? e->setup.node.map_frame : worldAbove(sensor, e->frames);
    if (world.empty() || !e->frames.areConnected(sensor, world)) continue;
    e->setup.node.pose_source = PoseSource::kTf;
    e->setup.node.map_frame = world;
    e->setup.has_poses = true;
    e->note("Poses come from TF: of '" + sensor + "' in '" + world + "'.",
            "Another frame of the map: --set map_frame=FRAME; poses of a topic: --odom TOPIC, "
            "--pose TOPIC or --transform TOPIC.");
    return true;
  }
  return false;
}

void reportNoPoses(Examination* e) {
  std::string what =
      "There are no poses: no nav_msgs/Odometry, geometry_msgs/PoseStamped or "
      "geometry_msgs/TransformStamped";
  what += e->frames.empty()
              ? ", and no TF"
              : ", and TF (" + e->frames.text() + ") does not say where " +
                    (e->hasScans() ? "'" + e->sensorFrame() + "'" : "a sensor") + " is in a world";
  const std::vector<std::string> foreign = foreignPoses(e->seen);
  std::vector<std::string> targets;
  for (const auto& [topic, poses] : e->seen.poses) {
    if (isTarget(topic)) targets.push_back(topic);
  }
  if (!foreign.empty()) what += "; of types that the map does not read: " + listOf(foreign);
  if (!targets.empty()) what += "; targets are no poses: " + listOf(targets);
  e->error(what + ".",
           "Start the estimator of the vehicle's pose: visual-inertial or LiDAR odometry, motion "
           "capture, or for PX4 mavros (/mavros/local_position/odom).");
}

bool prefersTf(const Examination& e) {
  return e.isGiven("pose_source") && e.setup.node.pose_source == PoseSource::kTf;
}

}  // namespace

void choosePoses(Examination* e) {
  if (useWish(e)) return;
  std::vector<PoseSource> sources = {PoseSource::kOdometry, PoseSource::kPose,
                                     PoseSource::kTransform, PoseSource::kTf};
  if (e->isGiven("pose_source")) {
    std::stable_partition(sources.begin(), sources.end(),
                          [e](PoseSource source) { return source == e->setup.node.pose_source; });
  }
  // Global poses only where there are no others.
  for (const bool only_local : {true, false}) {
    for (const PoseSource source : sources) {
      const bool is_tf = source == PoseSource::kTf;
      if (is_tf && only_local && !prefersTf(*e)) continue;
      if (is_tf ? useTf(e) : useTopic(source, only_local, e)) return;
    }
  }
  for (const char* type : kPoseTypes) {
    for (const std::string& topic : topicsOfType(type, e->seen)) {
      if (isTarget(topic) || isOutputOfMap(topic, e->seen)) continue;
      reportSilence(topic, e);
      return;
    }
  }
  reportNoPoses(e);
}

}  // namespace fiimap
