#include "fiimap/ros/pose_messages.h"

namespace fiimap {
namespace {

geometry_msgs::TransformStamped toTransform(const std_msgs::Header& header,
                                            const std::string& child_frame,
                                            const geometry_msgs::Pose& pose) {
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = child_frame;
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.translation.z = pose.position.z;
  transform.transform.rotation = pose.orientation;
  return transform;
}

}  // namespace

geometry_msgs::TransformStamped toTransform(const nav_msgs::Odometry& odometry) {
  return toTransform(odometry.header, odometry.child_frame_id, odometry.pose.pose);
}

geometry_msgs::TransformStamped toTransform(const geometry_msgs::PoseStamped& pose) {
  return toTransform(pose.header, "", pose.pose);
}

}  // namespace fiimap
