#include "fiimap/ros/camera_setup_check.h"

#include <cmath>

#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

constexpr int kViews = 5;               // images to look at
constexpr double kVerticalAxis = 0.94;  // cosine of 20 degrees

}  // namespace

std::string CameraSetupCheck::look(const sensor_msgs::CameraInfo& info) {
  if (info_seen_) return "";
  info_seen_ = true;
  return distortionWarning(info);
}

std::string CameraSetupCheck::look(const ResolvedPose& camera, const std::string& frame) {
  if (views_ == kViews) return "";
  ++views_;
  const double optical_axis_up_W = camera.T_W_S.linear()(2, 2);
  if (camera.sensor_axes_like_body && std::abs(optical_axis_up_W) > kVerticalAxis) ++views_up_;
  if (views_up_ < kViews) return "";
  return "the camera of frame '" + frame +
         "' looks straight up or down and is not rotated on its body: this is a body frame (x "
         "forward) used as an optical frame (z forward). Give the image the frame_id of the "
         "optical frame, or set extrinsic_rotation (-0.5 0.5 -0.5 0.5 for a camera that looks "
         "along x)";
}

}  // namespace fiimap
