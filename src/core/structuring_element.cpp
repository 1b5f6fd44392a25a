#include "fiimap/structuring_element.h"

#include <cmath>
#include <cstdlib>

namespace fiimap {
namespace {

/// A radius written as a whole number of voxels (0.3 m at 0.1 m) must keep its outermost voxels
/// although the quotient is not exact in floating point.
constexpr double kRadiusSlack = 1e-6;

}  // namespace

StructuringElement::StructuringElement(ElementShape shape, double radius, double resolution)
    : shape_(shape), radius_(radius) {
  const double voxels = radius / resolution;
  radius_voxels_ = shape == ElementShape::kBall ? voxels * (1.0 + kRadiusSlack)
                                                : std::ceil(voxels * (1.0 - kRadiusSlack));
  reach_ = static_cast<int>(std::floor(radius_voxels_));

  for (int dx = -reach_; dx <= reach_; ++dx) {
    for (int dy = -reach_; dy <= reach_; ++dy) {
      int half_height = -1;
      while (half_height < reach_ && satisfiesDefinition({dx, dy, half_height + 1})) ++half_height;
      half_heights_.push_back(half_height);
      for (int dz = -half_height; half_height >= 0 && dz <= half_height; ++dz) {
        offsets_.emplace_back(dx, dy, dz);
      }
    }
  }
}

int StructuringElement::halfHeight(int dx, int dy) const {
  if (std::abs(dx) > reach_ || std::abs(dy) > reach_) return -1;
  return half_heights_[(dx + reach_) * (2 * reach_ + 1) + dy + reach_];
}

bool StructuringElement::contains(const VoxelIndex& offset) const {
  return std::abs(offset.z()) <= halfHeight(offset.x(), offset.y());
}

bool StructuringElement::satisfiesDefinition(const VoxelIndex& offset) const {
  switch (shape_) {
    case ElementShape::kBall:
      return offset.cast<double>().norm() <= radius_voxels_;
    case ElementShape::kCube:
      return offset.cwiseAbs().maxCoeff() <= radius_voxels_;
    case ElementShape::kDiamond:
      return offset.cwiseAbs().sum() <= radius_voxels_;
  }
  return false;
}

}  // namespace fiimap
