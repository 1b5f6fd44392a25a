#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>

#include "fiimap/ros/pose_resolver.h"

namespace fiimap {

/// Looks for the usual mistakes in the setup of a depth camera, at the first messages only.
class CameraSetupCheck {
 public:
  /// \return what to warn the user of; empty when all is well or was said before.
  std::string look(const sensor_msgs::CameraInfo& info);
  /// \param frame frame_id of the image.
  std::string look(const ResolvedPose& camera, const std::string& frame);

 private:
  bool info_seen_ = false;
  int views_ = 0;
  int views_up_ = 0;
};

}  // namespace fiimap
