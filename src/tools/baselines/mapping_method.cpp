#include "mapping_method.h"

#include <stdexcept>

#include "ego_style_map.h"
#include "octomap_map.h"
#include "per_pixel_map.h"

namespace fiimap::bench {
MapperConfig configAt(double resolution, int reach, ElementShape shape) {
  MapperConfig config;
  config.resolution = resolution;
  config.inflation_radius = reach * resolution;
  config.inflation_shape = shape;
  return config;
}

VoxelBox updateBox(const MapperConfig& config, const ScanPose& pose) {
  const VoxelLattice lattice(config.resolution);
  return VoxelLattice::boxAround(lattice.indexOf(pose.vehicle_W),
                                 lattice.sizeOf(config.localUpdateRange()));
}

VoxelBox boxAround(const VoxelBox& a, const VoxelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

VoxelBox boxAroundFrames(const MapperConfig& config, const std::vector<Frame>& frames) {
  VoxelBox all;
  for (const Frame& frame : frames) all = boxAround(all, updateBox(config, frame.pose));
  return all;
}

bool isArrayMap(const std::string& name) {
  return name == kEgoStyle || name == kEgoStyleAsShipped || name == kPerPixel;
}

std::unique_ptr<MappingMethod> makeMethod(const std::string& name, const MapperConfig& config,
                                          const VoxelBox& box) {
  if (name == kFiimap) return std::make_unique<FiimapMethod>(config);
  if (name == kOctomap) return std::make_unique<OctomapMap>(config);
  if (name == kPerPixel) return std::make_unique<PerPixelMap>(config, box);
  MapperConfig ego_config = config;
  if (name == kEgoStyleAsShipped) {
    ego_config.invalid_depth = ReadingPolicy::kFree;
  } else if (name != kEgoStyle) {
    throw std::invalid_argument("no mapping method is called " + name);
  }
  return std::make_unique<EgoStyleMap>(ego_config, box);
}

std::unique_ptr<MappingMethod> makeMethod(const std::string& name, const MapperConfig& config,
                                          const std::vector<Frame>& frames) {
  return makeMethod(name, config, boxAroundFrames(config, frames));
}

}  // namespace fiimap::bench
