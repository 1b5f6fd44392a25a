#include <algorithm>

#include "doctor/checks.h"
#include "doctor/mount.h"
#include "fiimap/ros/frame_id.h"

namespace fiimap {
namespace {

bool isCamera(const Examination& e) {
  return !e.setup.depth_image.empty() || e.sensorFrame().find("optical") != std::string::npos;
}

/// The highest frame above the sensor that is not the world; empty where there is none.
std::string bodyAbove(const std::string& sensor, const Examination& e) {
  std::string body;
  for (const std::string& frame : e.frames.chainToRoot(sensor)) {
    const bool is_world = frame == e.setup.node.map_frame || frame == "odom" || frame == "map" ||
                          frame == "world" || frame == "earth";
    if (is_world) break;
    if (frame != sensor) body = frame;
  }
  return body;
}

std::string publisherCommand(const std::string& body, const std::string& sensor,
                             const std::string& rotation) {
  return "rosrun tf2_ros static_transform_publisher X Y Z " + rotation + " " + body + " " + sensor;
}

/// TF knows nothing of the sensor: it is taken to look ahead from the body's origin.
void assumeMount(const std::string& why, const std::string& body, Examination* e) {
  const bool is_camera = isCamera(*e);
  const std::string rotation = is_camera ? kOpticalRotation : "0 0 0 1";
  const std::string sensor = e->sensorFrame();
  e->error(why,
           std::string("The launch line takes the sensor to be at the body's origin") +
               (is_camera ? " and to look ahead" : " and turned like it") +
               ": correct extrinsic_translation (metres ahead, to the left, up) and "
               "extrinsic_rotation there, or publish where it is:",
           Repair::kInLaunchLine,
           publisherCommand(body.empty() ? "base_link" : body, sensor.empty() ? "SENSOR" : sensor,
                            rotation));
  e->change("extrinsics", "parameter");
  e->change("extrinsic_translation", "0 0 0");
  e->change("extrinsic_rotation", rotation);
}

/// The sensor's frames begin at `top`, which nothing connects with the body.
void assumeBody(const std::string& body, const std::string& top, Examination* e) {
  const std::string sensor = e->sensorFrame();
  e->error("The body of the poses is '" + body + "', but TF does not " +
               (e->frames.contains(body) ? "connect it with the sensor" : "know it") +
               ": the sensor's frame '" + sensor + "' hangs on '" + top +
               "' (TF: " + e->frames.text() + ").",
           "The launch line takes '" + top +
               "' for the body (body_frame), as if both were one. Better publish the transform "
               "between them, X Y Z in metres ahead, to the left and up:",
           Repair::kInLaunchLine, publisherCommand(body, top, "0 0 0 1"));
  e->change("body_frame", top);
}

/// Whether all sensors hang on a frame: then it may stand for the body.
bool carriesAll(const std::string& frame, const Examination& e) {
  const std::vector<std::string> sensors = e.sensorFrames();
  return std::all_of(sensors.begin(), sensors.end(), [&](const std::string& sensor) {
    return e.frames.areConnected(frame, sensor);
  });
}

void checkUnnamedBody(const std::string& top, Examination* e) {
  const bool can_name = e->setup.node.pose_source != PoseSource::kPose;
  if (top.empty()) {
    assumeMount("The poses of " + e->setup.poses + " do not name their body" +
                    (can_name ? " (child_frame_id is empty)" : "") +
                    ", and TF does not know where the sensor's frame '" + e->sensorFrame() +
                    "' is on it.",
                "", e);
    return;
  }
  const std::string remedy = "The launch line sets body_frame: " + top +
                             ", the highest frame above the sensor's; correct it if the poses are "
                             "those of another frame.";
  if (can_name) {
    e->error("The poses of " + e->setup.poses + " do not name their body: child_frame_id is empty.",
             "Let their publisher fill it in. " + remedy, Repair::kInLaunchLine);
  } else {
    e->note("Poses of type geometry_msgs/PoseStamped do not name their body.", remedy);
  }
  e->change("body_frame", top);
}

/// Poses of TF are those of the sensor; of several sensors, those of a body.
void checkBodyOnTf(const std::string& top, Examination* e) {
  const bool is_one_of_several = e->setup.sensors.size() > 1;
  const std::string sensor = e->sensorFrame();
  if (e->setup.node.body_frame.empty()) {
    const std::string body = top.empty() && is_one_of_several ? sensor : top;
    if (!body.empty()) e->change("body_frame", body);
  } else if (is_one_of_several && e->setup.node.extrinsics == ExtrinsicsSource::kTf &&
             !e->frames.areConnected(e->setup.node.body_frame, sensor)) {
    assumeMount("TF does not say where the sensor's frame '" + sensor + "' is on the body '" +
                    e->setup.node.body_frame + "' (TF: " + e->frames.text() + ").",
                e->setup.node.body_frame, e);
  }
}

}  // namespace

void checkBodyFrame(Examination* e) {
  if (!e->hasScans() || !e->setup.has_poses) return;
  NodeConfig& config = e->setup.node;
  const std::string sensor = e->sensorFrame();
  const std::string top = bodyAbove(sensor, *e);
  if (config.pose_source == PoseSource::kTf) {
    checkBodyOnTf(top, e);
    return;
  }
  const std::string child =
      plainFrame(e->seen.poses.at(e->setup.poses).back().message->child_frame_id);
  const std::string body = config.body_frame.empty() ? child : config.body_frame;
  if (config.extrinsics == ExtrinsicsSource::kParameter) return;
  if (sensor.empty()) {
    assumeMount("The messages of " + e->setup.scans() + " name no frame: header.frame_id is empty.",
                body, e);
  } else if (body.empty()) {
    checkUnnamedBody(top, e);
  } else if (!e->frames.areConnected(body, sensor) && body != sensor) {
    if (top.empty() || !carriesAll(top, *e)) {
      assumeMount(
          "TF does not say where the sensor's frame '" + sensor + "' is on the body '" + body +
              "'" + (e->frames.empty() ? ": there is no TF." : " (TF: " + e->frames.text() + ")."),
          body, e);
    } else {
      assumeBody(body, top, e);
    }
  }
}

}  // namespace fiimap
