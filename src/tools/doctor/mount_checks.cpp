#include <algorithm>
#include <optional>

#include "doctor/checks.h"
#include "doctor/mount.h"
#include "fiimap/ros/frame_id.h"

namespace fiimap {
namespace {

constexpr double kMuchRoll = 30.0;  // degrees

/// Camera to body, as the setup says; nothing where it does not.
std::optional<Eigen::Isometry3d> cameraOnBody(const Examination& e) {
  const NodeConfig& config = e.setup.node;
  if (config.extrinsics == ExtrinsicsSource::kParameter) return config.parameterExtrinsics();
  std::string body = config.body_frame;
  const auto poses = e.seen.poses.find(e.setup.poses);
  if (body.empty() && poses != e.seen.poses.end()) {
    body = plainFrame(poses->second.back().message->child_frame_id);
  }
  return body.empty() ? std::nullopt : e.frames.transform(body, e.sensorFrame());
}

std::string numbers(const Eigen::Vector3d& v) {
  return plainNumber(v.x()) + ' ' + plainNumber(v.y()) + ' ' + plainNumber(v.z());
}

/// The optical frame below a body frame of a camera, if TF has it.
std::string opticalBelow(const std::string& frame, const FrameGraph& frames) {
  const std::vector<std::string> children = frames.childrenOf(frame);
  const auto found = std::find_if(children.begin(), children.end(), [](const std::string& child) {
    return child.find("optical") != std::string::npos;
  });
  return found == children.end() ? "" : *found;
}

void turnBodyFrame(const Eigen::Isometry3d& T_B_F, Examination* e) {
  const std::string frame = e->sensorFrame();
  const std::string optical = opticalBelow(frame, e->frames);
  Eigen::Isometry3d T_B_C = T_B_F;
  T_B_C.rotate(opticalRotation());
  Eigen::Quaterniond rotation(T_B_C.linear());
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;  // the same rotation, as it is usually written
  e->error(
      "The depth image is of the frame '" + frame +
          "', which is a body frame (x ahead) and no optical frame (z ahead): its camera would "
          "look up, its z axis is " +
          numbers(T_B_F.linear().col(2)) + " in the body.",
      "Give the image the frame_id of the optical frame" +
          (optical.empty() ? std::string() : ", '" + optical + "'") +
          "; the launch line turns the frame with extrinsic_rotation instead.",
      Repair::kInLaunchLine);
  e->change("extrinsics", "parameter");
  e->change("extrinsic_translation", numbers(T_B_C.translation()));
  e->change("extrinsic_rotation", numbers(rotation.vec()) + ' ' + plainNumber(rotation.w()));
}

}  // namespace

void checkMount(Examination* e) {
  if (e->setup.depth_image.empty() || !e->hasScans() || !e->setup.has_poses) return;
  const std::optional<Eigen::Isometry3d> T_B_C = cameraOnBody(*e);
  if (!T_B_C) return;
  const Mount mount(*T_B_C);
  const std::string direction = mount.direction();
  const std::string frame = e->sensorFrame();
  if (mount.isBodyFrame() && frame.find("optical") == std::string::npos) {
    turnBodyFrame(*T_B_C, e);
    return;
  }
  const std::string axis = " (its optical axis is " + numbers(mount.view) + " in the body)";
  if (direction != "ahead" && direction != "down") {
    const std::string what = "The camera of frame '" + frame + "' looks " + direction +
                             ", seen from the vehicle" + axis + ".";
    const std::string remedy =
        "If it is not mounted so, correct the extrinsics: one that looks ahead has the rotation "
        "-0.5 0.5 -0.5 0.5 to the body, and bodies are x ahead, y left, z up.";
    // Of several cameras, some look elsewhere.
    if (e->setup.sensors.size() > 1) {
      e->note(what, remedy);
    } else {
      e->warn(what, remedy);
    }
  }
  if (mount.rollDegrees() > kMuchRoll) {
    e->warn(
        "The image of frame '" + frame + "' is rolled by " +
            withUnit(mount.rollDegrees(), "degrees", 0) + " against the vehicle" + axis + ".",
        "If the camera is not mounted so, correct the extrinsics: y of an optical frame is down "
        "the image.");
  }
}

}  // namespace fiimap
