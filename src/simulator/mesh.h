#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace fiimap::sim {

/// Triangles, m. All geometry of the simulator is made of them: rays, distances and rviz see the
/// same surfaces, whether they were generated or read from a file.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;  ///< indices of vertices

  void append(const Mesh& other);
  void translate(const Eigen::Vector3f& offset);
  Eigen::AlignedBox3f bounds() const;

  /// \param yaw rotation about the vertical axis through the centre, rad.
  void addBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw = 0.0);
  /// Box between two corners.
  void addBoxBetween(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Closed prism or cone frustum around the line from `base` to `tip`, its corners on the circles.
  void addCylinder(const Eigen::Vector3d& base, const Eigen::Vector3d& tip, double base_radius,
                   double tip_radius, int sides);
  /// Icosahedron, subdivided once, its corners on the ellipsoid.
  void addEllipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half_size);
};

}  // namespace fiimap::sim
