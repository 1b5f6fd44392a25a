#include "fiimap/ignored_volumes.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace fiimap {

bool IgnoredSphere::countsAt(std::int64_t stamp_ns) const {
  return std::abs(stamp_ns - this->stamp_ns) <= lifetime_ns;
}

void IgnoredVolumes::add(const std::vector<IgnoredSphere>& spheres) {
  spheres_.insert(spheres_.end(), spheres.begin(), spheres.end());
  if (spheres_.size() > kMaxSpheres) spheres_.erase(spheres_.begin(), spheres_.end() - kMaxSpheres);
}

std::size_t IgnoredVolumes::removeReturns(const Eigen::Isometry3d& T_W_B, std::int64_t stamp_ns,
                                          RangeData* scan) {
  counting_.clear();
  std::copy_if(spheres_.begin(), spheres_.end(), std::back_inserter(counting_),
               [=](const IgnoredSphere& sphere) { return sphere.countsAt(stamp_ns); });
  if (!has_body_ && counting_.empty()) return 0;  // mostly

  // Offsets from the sensor, as the returns are, keep their digits far from the world's origin.
  const Eigen::Matrix3d R_B_W = T_W_B.linear().transpose();
  const Eigen::Vector3d sensor_B = R_B_W * (scan->origin - T_W_B.translation());
  for (IgnoredSphere& sphere : counting_) sphere.center_W -= scan->origin;
  const auto isIgnored = [&](const Eigen::Vector3d& offset) {
    return (has_body_ && isInBody(sensor_B + R_B_W * offset)) ||
           std::any_of(counting_.begin(), counting_.end(), [&](const IgnoredSphere& sphere) {
             return (offset - sphere.center_W).squaredNorm() <= sphere.radius * sphere.radius;
           });
  };
  PointList& returns = scan->returns;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (isIgnored(returns[i].cast<double>())) continue;
    returns.x()[kept] = returns.x()[i];
    returns.y()[kept] = returns.y()[i];
    returns.z()[kept] = returns.z()[i];
    ++kept;
  }
  const std::size_t removed = returns.size() - kept;
  returns.resize(kept);
  return removed;
}

void IgnoredVolumes::freeBody(const Eigen::Isometry3d& T_W_B, const VoxelLattice& lattice,
                              ScanMask* mask) const {
  if (!has_body_) return;
  const Eigen::Isometry3d T_B_W = T_W_B.inverse();
  const Eigen::Vector3d reach_W = T_W_B.linear().cwiseAbs() * half_body_;
  const VoxelBox box = VoxelBox{lattice.indexOf(T_W_B.translation() - reach_W),
                                lattice.indexOf(T_W_B.translation() + reach_W).array() + 1}
                           .intersection(mask->box());
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      for (int z = box.min.z(); z < box.max.z(); ++z) {
        const VoxelIndex v(x, y, z);
        if (!isInBody(T_B_W * lattice.centerOf(v))) continue;
        const VoxelIndex in_mask = v - mask->box().min;
        mask->touch(in_mask.x(), in_mask.y());
        mask->mark(ScanMask::kFree, in_mask);
      }
    }
  }
}

}  // namespace fiimap
