#pragma once

#include <Eigen/Core>
#include <geometry_msgs/Point.h>

namespace fiimap {

inline geometry_msgs::Point toPoint(const Eigen::Vector3d& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

}  // namespace fiimap
