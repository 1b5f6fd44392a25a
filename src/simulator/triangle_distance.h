#pragma once

#include "mesh.h"

namespace fiimap::sim {

/// Distance from a point to the triangle a b c, m. The regions of the plane around the triangle are
/// told apart by the signs of barycentric areas (Ericson, Real-Time Collision Detection, 5.1.5).
double distanceToTriangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// To a triangle of a mesh.
double distanceToTriangle(const Eigen::Vector3d& point, const Mesh& mesh,
                          const Eigen::Vector3i& triangle);

}  // namespace fiimap::sim
