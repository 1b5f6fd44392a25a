#include <algorithm>
#include <cmath>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

std::string sizeText(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

/// Of the full-resolution image: P belongs to the rectified image, K to the raw one.
PinholeIntrinsics fullResolutionIntrinsics(const sensor_msgs::CameraInfo& info) {
  if (info.P[0] != 0.0) return {info.P[0], info.P[5], info.P[2], info.P[6]};
  return {info.K[0], info.K[4], info.K[2], info.K[5]};
}

}  // namespace

PinholeIntrinsics decodeCameraInfo(const sensor_msgs::CameraInfo& info, std::uint32_t width,
                                   std::uint32_t height) {
  PinholeIntrinsics intrinsics = fullResolutionIntrinsics(info);
  if (!intrinsics.valid()) {
    throw InputError(DropReason::kBadCameraInfo,
                     "the camera is not calibrated: focal lengths in P and K are not positive");
  }
  const std::uint32_t binning_x = std::max(info.binning_x, 1u);
  const std::uint32_t binning_y = std::max(info.binning_y, 1u);
  const std::uint32_t info_width = (info.roi.width > 0 ? info.roi.width : info.width) / binning_x;
  const std::uint32_t info_height =
      (info.roi.height > 0 ? info.roi.height : info.height) / binning_y;
  if (info_width != width || info_height != height) {
    throw InputError(DropReason::kBadCameraInfo,
                     "camera_info describes an image of " + sizeText(info_width, info_height) +
                         ", the depth image is " + sizeText(width, height));
  }
  intrinsics.fx /= binning_x;
  intrinsics.fy /= binning_y;
  intrinsics.cx = (intrinsics.cx - info.roi.x_offset) / binning_x;
  intrinsics.cy = (intrinsics.cy - info.roi.y_offset) / binning_y;
  return intrinsics;
}

std::string distortionWarning(const sensor_msgs::CameraInfo& info) {
  const bool distorted =
      std::any_of(info.D.begin(), info.D.end(), [](double d) { return d != 0.0; });
  if (!distorted) return "";
  return "camera_info has distortion coefficients: the depth image must be rectified (image_rect); "
         "a raw one bends walls";
}

}  // namespace fiimap
