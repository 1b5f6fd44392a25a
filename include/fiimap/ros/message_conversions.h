#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <memory>
#include <string>

#include "fiimap/depth_projector.h"
#include "fiimap/point_projector.h"

namespace fiimap {

/// A depth image as the mapper wants it, with the memory that its view looks at.
struct DecodedDepthImage {
  DepthImage view;                     ///< valid as long as `pixels` lives
  std::shared_ptr<const void> pixels;  ///< the message, or a copy in native byte order
};

/// Whether images of an encoding are depth images: 16UC1, mono16 or 32FC1.
bool isDepthEncoding(const std::string& encoding);

/// View of a message of encoding 16UC1, mono16 (depth_scale) or 32FC1 (metres), without a copy when
/// its byte order is the machine's and its rows are a whole number of pixels apart.
/// \throws InputError (kBadEncoding, kBadImage).
DecodedDepthImage decodeDepthImage(const sensor_msgs::ImageConstPtr& message);

/// Intrinsics of a rectified image of the given size (pixels): P where it is set, else K.
/// \throws InputError (kBadCameraInfo).
PinholeIntrinsics decodeCameraInfo(const sensor_msgs::CameraInfo& info, std::uint32_t width,
                                   std::uint32_t height);

/// What to tell the user when the camera has distortion; empty when it has none.
std::string distortionWarning(const sensor_msgs::CameraInfo& info);

/// Points in the cloud's own frame, those that are not finite included (the mapper counts them).
/// \param pixel_step use every n-th point of every n-th row of an organised cloud; 0 means 1.
/// \throws InputError (kBadCloud).
void decodePointCloud(const sensor_msgs::PointCloud2& cloud, int pixel_step, PointScan* scan);

}  // namespace fiimap
