#include "triangle_distance.h"

namespace fiimap::sim {
namespace {

using Eigen::Vector3d;

/// Distance to the line from `from` along `edge` at a fraction of its length.
double distanceAt(const Vector3d& point, const Vector3d& from, const Vector3d& edge, double share) {
  return (point - from - share * edge).norm();
}

}  // namespace

double distanceToTriangle(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                          const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = ab.dot(point - a), d2 = ac.dot(point - a);
  if (d1 <= 0.0 && d2 <= 0.0) return (point - a).norm();
  const double d3 = ab.dot(point - b), d4 = ac.dot(point - b);
  if (d3 >= 0.0 && d4 <= d3) return (point - b).norm();
  const double area_c = d1 * d4 - d3 * d2;
  if (area_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return distanceAt(point, a, ab, d1 / (d1 - d3));
  const double d5 = ab.dot(point - c), d6 = ac.dot(point - c);
  if (d6 >= 0.0 && d5 <= d6) return (point - c).norm();
  const double area_b = d5 * d2 - d1 * d6;
  if (area_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return distanceAt(point, a, ac, d2 / (d2 - d6));
  const double area_a = d3 * d6 - d5 * d4;
  if (area_a <= 0.0 && d4 >= d3 && d5 >= d6) {
    return distanceAt(point, b, c - b, (d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const double area = area_a + area_b + area_c;
  return (point - a - ab * (area_b / area) - ac * (area_c / area)).norm();
}

double distanceToTriangle(const Vector3d& point, const Mesh& mesh,
                          const Eigen::Vector3i& triangle) {
  const auto corner = [&](int i) -> Vector3d {
    return mesh.vertices[static_cast<std::size_t>(triangle[i])].cast<double>();
  };
  return distanceToTriangle(point, corner(0), corner(1), corner(2));
}

}  // namespace fiimap::sim
