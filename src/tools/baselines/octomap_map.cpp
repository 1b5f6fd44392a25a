#include "octomap_map.h"

namespace fiimap::bench {
namespace {

/// Rays without return are given to OctoMap as points beyond its maximum range, by more than a
/// voxel's diagonal: it moves points to the middle of their voxel before it looks how far they are.
constexpr double kBeyond = 2.0;  // voxel edges

octomap::point3d pointOf(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

OctomapMap::OctomapMap(const MapperConfig& config) : config_(config), tree_(config.resolution) {
  tree_.setProbHit(config.p_hit);
  tree_.setProbMiss(config.p_miss);
  tree_.setClampingThresMin(config.p_min);
  tree_.setClampingThresMax(config.p_max);
  tree_.setOccupancyThres(config.p_occ);
}

void OctomapMap::integrate(const Frame& frame) {
  projectPixels(frame, config_, &points_);
  const Eigen::Vector3d origin = frame.pose.T_W_S.translation();
  const double beyond = config_.max_ray_length + kBeyond * config_.resolution;
  cloud_.clear();
  for (const PixelPoint& point : points_) {
    const Eigen::Vector3d ray = point.end_W - origin;
    const double scale = point.is_return ? 1.0 : beyond / ray.norm();
    cloud_.push_back(pointOf(origin + scale * ray));
  }
  const bool lazy = false;
  const bool discretize = true;
  tree_.insertPointCloud(cloud_, pointOf(origin), config_.max_ray_length, lazy, discretize);
}

std::vector<VoxelIndex> OctomapMap::occupied(const VoxelBox& box) const {
  std::vector<VoxelIndex> found;
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      for (int z = box.min.z(); z < box.max.z(); ++z) {
        if (occupancy({x, y, z}) == Occupancy::kOccupied) found.emplace_back(x, y, z);
      }
    }
  }
  return found;
}

Occupancy OctomapMap::occupancy(const VoxelIndex& v) const {
  const auto key = [](int index) { return static_cast<octomap::key_type>(index + kCenterKey); };
  const octomap::OcTreeNode* node =
      tree_.search(octomap::OcTreeKey(key(v.x()), key(v.y()), key(v.z())));
  if (node == nullptr) return Occupancy::kUnknown;
  return tree_.isNodeOccupied(node) ? Occupancy::kOccupied : Occupancy::kFree;
}

}  // namespace fiimap::bench
