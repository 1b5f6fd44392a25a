#pragma once

#include <octomap/octomap.h>

#include "mapping_method.h"
#include "pixel_points.h"

namespace fiimap::bench {

/// OctoMap's insertPointCloud with discretisation: one ray per distinct end voxel. It inflates
/// nothing and forgets nothing. It reaches 2^15 voxels from the origin.
class OctomapMap : public MappingMethod {
 public:
  explicit OctomapMap(const MapperConfig& config);

  void integrate(const Frame& frame) override;
  std::vector<VoxelIndex> occupied(const VoxelBox& box) const override;

  Occupancy occupancy(const VoxelIndex& v) const;
  /// Calls visit(voxel, state) for every voxel that is free or occupied.
  template <typename Visitor>
  void forEachKnown(Visitor&& visit) const;

 private:
  /// Key of the voxel whose lowest corner is the origin: OctoMap's lattice is ours.
  static constexpr int kCenterKey = 1 << 15;

  MapperConfig config_;
  octomap::OcTree tree_;
  std::vector<PixelPoint> points_;
  octomap::Pointcloud cloud_;
};

template <typename Visitor>
void OctomapMap::forEachKnown(Visitor&& visit) const {
  for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) {
    const Occupancy state = tree_.isNodeOccupied(*leaf) ? Occupancy::kOccupied : Occupancy::kFree;
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int side = 1 << (tree_.getTreeDepth() - leaf.getDepth());  // pruned: a cube of voxels
    for (int dx = 0; dx < side; ++dx) {
      for (int dy = 0; dy < side; ++dy) {
        for (int dz = 0; dz < side; ++dz) {
          visit(VoxelIndex(first[0] + dx, first[1] + dy, first[2] + dz).array() - kCenterKey,
                state);
        }
      }
    }
  }
}

}  // namespace fiimap::bench
