#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "random.h"
#include "worlds/world.h"

/// Rays and distances from their definitions, in double precision and without any tree.
namespace fiimap::sim::test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// All triangles of a world at a time.
inline Mesh meshAt(const World& world, double time) {
  Mesh mesh = world.still;
  for (const MovingObstacle& obstacle : world.moving) {
    Mesh moved = obstacle.shape;
    moved.translate(obstacle.positionAt(time).cast<float>());
    mesh.append(moved);
  }
  return mesh;
}

inline Eigen::Matrix3d corners(const Mesh& mesh, const Eigen::Vector3i& triangle) {
  Eigen::Matrix3d columns;
  for (int i = 0; i < 3; ++i) {
    columns.col(i) = mesh.vertices[static_cast<std::size_t>(triangle[i])].cast<double>();
  }
  return columns;
}

/// Multiple of the direction at which a ray meets the triangle: the solution of
/// origin + t direction = a + u (b - a) + v (c - a) with u, v, 1 - u - v >= 0.
inline double alongRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       const Eigen::Matrix3d& c) {
  Eigen::Matrix3d equations;
  equations << -direction, c.col(1) - c.col(0), c.col(2) - c.col(0);
  const double determinant = equations.determinant();
  if (std::abs(determinant) < 1e-14) return kInfinity;
  const Eigen::Vector3d tuv = equations.inverse() * (origin - c.col(0));
  const bool inside = tuv[1] >= 0.0 && tuv[2] >= 0.0 && tuv[1] + tuv[2] <= 1.0;
  return inside && tuv[0] > 0.0 ? tuv[0] : kInfinity;
}

inline double alongRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       const Mesh& mesh) {
  double nearest = kInfinity;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    nearest = std::min(nearest, alongRay(origin, direction, corners(mesh, triangle)));
  }
  return nearest;
}

/// Distance to a segment, by projection.
inline double toSegment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double share = std::clamp((point - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (point - a - share * ab).norm();
}

/// Distance to a triangle: to its plane where the foot lies inside, otherwise to its nearest side.
inline double toTriangle(const Eigen::Vector3d& point, const Eigen::Matrix3d& c) {
  double nearest =
      std::min({toSegment(point, c.col(0), c.col(1)), toSegment(point, c.col(1), c.col(2)),
                toSegment(point, c.col(2), c.col(0))});
  const Eigen::Vector3d normal = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).normalized();
  for (const double side : {1.0, -1.0}) {
    nearest = std::min(nearest, alongRay(point, side * normal, c));
  }
  return nearest;
}

inline double toMesh(const Eigen::Vector3d& point, const Mesh& mesh) {
  double nearest = kInfinity;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    nearest = std::min(nearest, toTriangle(point, corners(mesh, triangle)));
  }
  return nearest;
}

inline Eigen::Vector3d randomPoint(Random* random, const Eigen::Vector3d& low,
                                   const Eigen::Vector3d& high) {
  const double x = random->uniform(low.x(), high.x());
  const double y = random->uniform(low.y(), high.y());
  const double z = random->uniform(low.z(), high.z());
  return {x, y, z};
}

}  // namespace fiimap::sim::test
