#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstdint>

#include "depth_camera.h"
#include "depth_noise.h"

namespace fiimap {

/// The first Kinect as the Cow_and_Lady recording has it: clouds of 640 x 480 points of a pinhole
/// of 525 pixels, z in whole millimetres and in steps of an eighth of a pixel of disparity (0.2 m
/// apart at 8 m), NaN where there is no depth. Not thread-safe.
class Kinect {
 public:
  explicit Kinect(std::uint64_t seed);

  /// Camera in the marker body, as published with the recording.
  static Eigen::Isometry3d T_V_C();

  /// Organised cloud in the layout of the recording, every `pixel_step`-th pixel of every
  /// `pixel_step`-th row, without colour; header unset.
  /// \param number of the scan: the same one gets the same errors.
  sensor_msgs::PointCloud2 scan(const sim::RayScene& scene, const Eigen::Isometry3d& T_W_C,
                                std::uint64_t number, int pixel_step);

 private:
  sim::CameraConfig config_;
  sim::DepthCamera camera_;
  sim::DepthNoise noise_;
};

}  // namespace fiimap
