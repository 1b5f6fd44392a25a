#include "inflation_check.h"

#include <cmath>
#include <vector>

namespace fiimap {
namespace {

/// Rounding of radius / resolution must not decide whether a voxel exactly at the radius belongs.
constexpr double kRelativeSlack = 1e-6;

bool inElement(const VoxelIndex& offset, const Snapshot::Info& info) {
  const double voxels = info.inflation_radius / info.resolution;
  const double whole_voxels = std::ceil(voxels * (1.0 - kRelativeSlack));
  switch (info.inflation_shape) {
    case ElementShape::kBall:
      return offset.cast<double>().norm() <= voxels * (1.0 + kRelativeSlack);
    case ElementShape::kCube:
      return offset.cwiseAbs().maxCoeff() <= whole_voxels;
    case ElementShape::kDiamond:
      return offset.cwiseAbs().sum() <= whole_voxels;
  }
  return false;
}

std::vector<VoxelIndex> elementByDefinition(const Snapshot::Info& info) {
  const int reach = static_cast<int>(std::ceil(info.inflation_radius / info.resolution)) + 1;
  std::vector<VoxelIndex> offsets;
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dz = -reach; dz <= reach; ++dz) {
        if (inElement({dx, dy, dz}, info)) offsets.emplace_back(dx, dy, dz);
      }
    }
  }
  return offsets;
}

/// One flag per voxel of a box.
class VoxelFlags {
 public:
  explicit VoxelFlags(const VoxelBox& box) : box_(box), flags_(box.volume(), 0) {}

  bool contains(const VoxelIndex& v) const { return box_.contains(v); }
  std::uint8_t& at(const VoxelIndex& v) {
    const VoxelIndex size = box_.size();
    const VoxelIndex i = v - box_.min;
    return flags_[(static_cast<std::size_t>(i.x()) * size.y() + i.y()) * size.z() + i.z()];
  }

 private:
  VoxelBox box_;
  std::vector<std::uint8_t> flags_;
};

VoxelBox boundsOf(const std::vector<VoxelIndex>& voxels, int margin) {
  if (voxels.empty()) return {};
  VoxelBox box{voxels.front(), voxels.front()};
  for (const VoxelIndex& v : voxels) {
    box.min = box.min.cwiseMin(v);
    box.max = box.max.cwiseMax(v);
  }
  return {box.min.array() - margin, box.max.array() + margin + 1};
}

}  // namespace

std::int64_t countInflationMismatches(const Snapshot& snapshot) {
  const std::vector<VoxelIndex> obstacles = snapshot.voxels(Plane::kOccupied, snapshot.window());
  const std::vector<VoxelIndex> offsets = elementByDefinition(snapshot.info());
  const int reach = offsets.back().x();
  VoxelFlags expected(boundsOf(obstacles, reach).intersection(snapshot.window()));

  std::int64_t missing = 0;  // expected and not found yet
  for (const VoxelIndex& obstacle : obstacles) {
    for (const VoxelIndex& offset : offsets) {
      const VoxelIndex v = obstacle + offset;
      if (!expected.contains(v) || expected.at(v) != 0) continue;
      expected.at(v) = 1;
      ++missing;
    }
  }
  std::int64_t spurious = 0;
  for (const VoxelIndex& v : snapshot.voxels(Plane::kInflated, snapshot.window())) {
    if (expected.contains(v) && expected.at(v) != 0) {
      --missing;
    } else {
      ++spurious;
    }
  }
  return missing + spurious;
}

}  // namespace fiimap
