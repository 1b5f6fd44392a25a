#pragma once

#include <Eigen/Geometry>
#include <string>

namespace fiimap {

/// From the optical frame of a camera that looks ahead to its body: quaternion x y z w.
extern const char* const kOpticalRotation;
Eigen::Quaterniond opticalRotation();

/// How a depth camera sits on a body (x forward, y left, z up).
struct Mount {
  Eigen::Vector3d view;  ///< unit vector along the optical axis, in the body frame
  Eigen::Vector3d down;  ///< unit vector down the image, in the body frame

  explicit Mount(const Eigen::Isometry3d& T_B_C);

  /// The frame is a body's, x ahead, that is used as an optical one: its z looks up, not ahead.
  bool isBodyFrame() const;
  /// "ahead", "up", "backwards", "to the left", ...
  std::string direction() const;
  /// Angle by which the image is rolled against the body, degrees in [0, 180]; of cameras that look
  /// up or down 0.
  double rollDegrees() const;
};

}  // namespace fiimap
