#pragma once

#include <geometry_msgs/Point.h>
#include <Eigen/Core>

namespace fiimap {

/// A point of a message, in the same unit and frame.
inline Eigen::Vector3d toEigen(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

/// A point as a message, in the same unit and frame.
inline geometry_msgs::Point toPoint(const Eigen::Vector3d& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

}  // namespace fiimap
