#pragma once

#include <Eigen/Core>

#include "exact_scene.h"

namespace fiimap {

/// Whether a point is ever nearer than `margin` (m) to something that comes, goes or moves.
bool isNearPassing(const ExactScene& scene, const Eigen::Vector3d& point_W, double margin);

}  // namespace fiimap
