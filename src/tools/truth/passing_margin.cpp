#include "truth/passing_margin.h"

#include <algorithm>
#include <cmath>

namespace fiimap {
namespace {

/// A bound that costs little: the ball around the shape, along the path of its centre.
double leastPossibleDistance(const ExactScene::Shape& shape, const Eigen::Vector3d& point_W) {
  Eigen::Vector3d path = Eigen::Vector3d::Zero();
  if (std::isfinite(shape.on) && std::isfinite(shape.off)) {
    path = shape.velocity * (shape.off - shape.on);
  }
  const Eigen::Vector3d from_start = point_W - shape.center;
  const double length_2 = path.squaredNorm();
  const double along = length_2 > 0.0 ? std::clamp(from_start.dot(path) / length_2, 0.0, 1.0) : 0.0;
  return (from_start - along * path).norm() - shape.half_size.norm();
}

}  // namespace

bool isNearPassing(const ExactScene& scene, const Eigen::Vector3d& point_W, double margin) {
  for (const ExactScene::Shape& shape : scene.shapes()) {
    if (shape.alwaysThere() || leastPossibleDistance(shape, point_W) >= margin) continue;
    if (shape.distanceWhileThere(point_W) < margin) return true;
  }
  return false;
}

}  // namespace fiimap
