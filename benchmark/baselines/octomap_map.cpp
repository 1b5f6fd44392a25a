#include "octomap_map.h"

namespace fiimap::bench {
namespace {

/// Rays without return are given to OctoMap as points a little beyond its maximum range.
constexpr double kBeyond = 1.01;

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
  cloud_.clear();
  for (const PixelPoint& point : points_) {
    const Eigen::Vector3d ray = point.end_W - origin;
    const double scale = point.is_return ? 1.0 : kBeyond * config_.max_ray_length / ray.norm();
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
        const Eigen::Vector3d center_W = VoxelLattice(config_.resolution).centerOf({x, y, z});
        const octomap::OcTreeNode* node = tree_.search(pointOf(center_W));
        if (node != nullptr && tree_.isNodeOccupied(node)) found.emplace_back(x, y, z);
      }
    }
  }
  return found;
}

}  // namespace fiimap::bench
