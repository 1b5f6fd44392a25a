#include "doctor/mount.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fiimap {
namespace {

constexpr double kVertical = 0.94;  // cosine of 20 degrees

struct Direction {
  const char* name;
  Eigen::Vector3d axis_B;
};

}  // namespace

const char* const kOpticalRotation = "-0.5 0.5 -0.5 0.5";

Eigen::Quaterniond opticalRotation() { return {0.5, -0.5, 0.5, -0.5}; }

Mount::Mount(const Eigen::Isometry3d& T_B_C)
    : view(T_B_C.linear().col(2)), down(T_B_C.linear().col(1)) {}

bool Mount::isBodyFrame() const {
  // Up, and what should be down the image is to the left as in a body, whatever its tilt ahead.
  return view.z() > std::sqrt(0.5) && down.y() > std::sqrt(0.5);
}

std::string Mount::direction() const {
  const std::array<Direction, 6> directions = {{{"ahead", Eigen::Vector3d::UnitX()},
                                                {"backwards", -Eigen::Vector3d::UnitX()},
                                                {"to the left", Eigen::Vector3d::UnitY()},
                                                {"to the right", -Eigen::Vector3d::UnitY()},
                                                {"up", Eigen::Vector3d::UnitZ()},
                                                {"down", -Eigen::Vector3d::UnitZ()}}};
  const auto nearest = std::max_element(directions.begin(), directions.end(),
                                        [this](const Direction& a, const Direction& b) {
                                          return a.axis_B.dot(view) < b.axis_B.dot(view);
                                        });
  return nearest->name;
}

double Mount::rollDegrees() const {
  if (std::abs(view.z()) > kVertical) return 0.0;
  // Down, as far as it lies in the image's plane.
  const Eigen::Vector3d down_B = -Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d level = (down_B - view * view.dot(down_B)).normalized();
  return std::acos(std::clamp(level.dot(down), -1.0, 1.0)) * 180.0 / M_PI;
}

}  // namespace fiimap
