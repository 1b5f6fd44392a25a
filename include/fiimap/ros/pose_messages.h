#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>

namespace fiimap {

/// Pose messages in one form; the transform takes points of the body to the frame of the header.
geometry_msgs::TransformStamped toTransform(const nav_msgs::Odometry& odometry);
/// A PoseStamped does not name its body: the child frame is empty.
geometry_msgs::TransformStamped toTransform(const geometry_msgs::PoseStamped& pose);

}  // namespace fiimap
