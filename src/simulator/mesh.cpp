#include "mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace fiimap::sim {
namespace {

/// Icosahedron with each triangle cut in four and all corners on the unit sphere.
Mesh makeUnitBall() {
  const auto golden = static_cast<float>((1.0 + std::sqrt(5.0)) / 2.0);
  Mesh ball;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float a : {-1.0f, 1.0f}) {
      for (const float b : {-golden, golden}) {
        Eigen::Vector3f corner;
        corner[axis] = 0.0f;
        corner[(axis + 1) % 3] = a;
        corner[(axis + 2) % 3] = b;
        ball.vertices.push_back(corner.normalized());
      }
    }
  }
  const float edge = (ball.vertices[0] - ball.vertices[2]).norm();  // 2 corners with the same b
  const auto are_neighbours = [&](int i, int j) {
    return (ball.vertices[i] - ball.vertices[j]).norm() < 1.1f * edge;
  };
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int i, int j) {
    const auto [found, is_new] =
        middles.try_emplace(std::minmax(i, j), static_cast<int>(ball.vertices.size()));
    if (is_new) ball.vertices.push_back((ball.vertices[i] + ball.vertices[j]).normalized());
    return found->second;
  };
  constexpr int kCorners = 12;
  for (int i = 0; i < kCorners; ++i) {
    for (int j = i + 1; j < kCorners; ++j) {
      for (int k = j + 1; k < kCorners; ++k) {
        if (!are_neighbours(i, j) || !are_neighbours(j, k) || !are_neighbours(i, k)) continue;
        const int ij = middle(i, j), jk = middle(j, k), ik = middle(i, k);
        for (const auto& triangle : {Eigen::Vector3i(i, ij, ik), Eigen::Vector3i(j, ij, jk),
                                     Eigen::Vector3i(k, ik, jk), Eigen::Vector3i(ij, jk, ik)}) {
          ball.triangles.push_back(triangle);
        }
      }
    }
  }
  return ball;
}

}  // namespace

void Mesh::append(const Mesh& other) {
  const auto first = static_cast<int>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& triangle : other.triangles) {
    triangles.emplace_back(triangle.array() + first);
  }
}

void Mesh::translate(const Eigen::Vector3f& offset) {
  for (Eigen::Vector3f& vertex : vertices) vertex += offset;
}

Eigen::AlignedBox3f Mesh::bounds() const {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : vertices) box.extend(vertex);
  return box;
}

void Mesh::addBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Mesh box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side((corner & 1) - 0.5, (corner >> 1 & 1) - 0.5, (corner >> 2) - 0.5);
    box.vertices.push_back((center + R * side.cwiseProduct(size)).cast<float>());
  }
  constexpr std::array<std::array<int, 4>, 6> kFaces = {
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  for (const auto& f : kFaces) {
    box.triangles.emplace_back(f[0], f[1], f[2]);
    box.triangles.emplace_back(f[0], f[2], f[3]);
  }
  append(box);
}

void Mesh::addBoxBetween(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  addBox((low + high) / 2.0, high - low);
}

void Mesh::addCylinder(const Eigen::Vector3d& base, const Eigen::Vector3d& tip, double base_radius,
                       double tip_radius, int sides) {
  const Eigen::Vector3d axis = (tip - base).normalized();
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d other = axis.cross(across);
  Mesh cylinder;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * i / sides;
    const Eigen::Vector3d side = std::cos(angle) * across + std::sin(angle) * other;
    cylinder.vertices.push_back((base + base_radius * side).cast<float>());
    cylinder.vertices.push_back((tip + tip_radius * side).cast<float>());
    const int low = 2 * i, next = 2 * ((i + 1) % sides);
    cylinder.triangles.emplace_back(low, next, low + 1);
    cylinder.triangles.emplace_back(low + 1, next, next + 1);
    cylinder.triangles.emplace_back(low, next, 2 * sides);
    cylinder.triangles.emplace_back(low + 1, next + 1, 2 * sides + 1);
  }
  cylinder.vertices.push_back(base.cast<float>());
  cylinder.vertices.push_back(tip.cast<float>());
  append(cylinder);
}

void Mesh::addEllipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half_size) {
  static const Mesh unit_ball = makeUnitBall();
  Mesh ellipsoid = unit_ball;
  for (Eigen::Vector3f& vertex : ellipsoid.vertices) {
    vertex = (center + vertex.cast<double>().cwiseProduct(half_size)).cast<float>();
  }
  append(ellipsoid);
}

}  // namespace fiimap::sim
