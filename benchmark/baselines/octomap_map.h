#pragma once

#include <octomap/octomap.h>

#include "mapping_method.h"
#include "pixel_points.h"

namespace fiimap::bench {

/// OctoMap's insertPointCloud with discretisation: one ray per distinct end voxel. It inflates
/// nothing and forgets nothing.
class OctomapMap : public MappingMethod {
 public:
  explicit OctomapMap(const MapperConfig& config);

  void integrate(const Frame& frame) override;
  std::vector<VoxelIndex> occupied(const VoxelBox& box) const override;

 private:
  MapperConfig config_;
  octomap::OcTree tree_;
  std::vector<PixelPoint> points_;
  octomap::Pointcloud cloud_;
};

}  // namespace fiimap::bench
