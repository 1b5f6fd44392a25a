#pragma once

#include <cmath>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <ros/time.h>

#include "fiimap/ros/drop_reason.h"

namespace fiimap {

constexpr std::uint32_t kStart = 1600000000;  // s

/// Stamp some seconds after the start of a test's time.
inline ros::Time at(double seconds) { return ros::Time(kStart) + ros::Duration(seconds); }

/// Pose at (x, 0, 0), turned by `yaw` about z.
inline geometry_msgs::TransformStamped transformAt(double seconds, double x, double yaw = 0.0,
                                                   const std::string& frame = "world",
                                                   const std::string& child = "body") {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = at(seconds);
  transform.header.frame_id = frame;
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation.z = std::sin(yaw / 2.0);
  transform.transform.rotation.w = std::cos(yaw / 2.0);
  return transform;
}

/// Expects that a call refuses its data for a reason, with a text that holds `part`.
template <typename Call>
void expectRefusal(DropReason reason, const std::string& part, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "accepted, expected " << nameOf(reason);
  } catch (const InputError& error) {
    EXPECT_STREQ(nameOf(error.reason()), nameOf(reason));
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace fiimap
