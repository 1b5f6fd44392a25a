#include "mapping_method.h"

#include <stdexcept>

#include "ego_style_map.h"
#include "octomap_map.h"
#include "per_pixel_map.h"

namespace fiimap::bench {
namespace {

/// This package's own map, snapshot included.
class FiimapMethod : public MappingMethod {
 public:
  explicit FiimapMethod(const MapperConfig& config) : mapper_(config) {}

  void integrate(const Frame& frame) override {
    fiimap::bench::integrate(frame, &mapper_);
    snapshot_ = mapper_.snapshot();
  }
  std::vector<VoxelIndex> occupied(const VoxelBox& box) const override {
    return snapshot_->voxels(Plane::kOccupied, box);
  }

 private:
  Mapper mapper_;
  std::shared_ptr<const Snapshot> snapshot_;
};

}  // namespace

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

VoxelBox boxAroundFrames(const MapperConfig& config, const std::vector<Frame>& frames) {
  VoxelBox all = updateBox(config, frames.front().pose);
  for (const Frame& frame : frames) {
    const VoxelBox box = updateBox(config, frame.pose);
    all = {all.min.cwiseMin(box.min), all.max.cwiseMax(box.max)};
  }
  return all;
}

std::unique_ptr<MappingMethod> makeMethod(const std::string& name, const MapperConfig& config,
                                          const std::vector<Frame>& frames) {
  if (name == kFiimap) return std::make_unique<FiimapMethod>(config);
  if (name == kOctomap) return std::make_unique<OctomapMap>(config);
  const VoxelBox box = boxAroundFrames(config, frames);
  if (name == kPerPixel) return std::make_unique<PerPixelMap>(config, box);
  MapperConfig ego_config = config;
  if (name == kEgoStyleAsShipped) {
    ego_config.invalid_depth = ReadingPolicy::kFree;
  } else if (name != kEgoStyle) {
    throw std::invalid_argument("no mapping method is called " + name);
  }
  return std::make_unique<EgoStyleMap>(ego_config, box);
}

}  // namespace fiimap::bench
