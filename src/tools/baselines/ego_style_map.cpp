#include "ego_style_map.h"

#include "ray_walk.h"

namespace fiimap::bench {

EgoStyleMap::EgoStyleMap(const MapperConfig& config, const VoxelBox& box)
    : ArrayMap(config, box),
      ended_in_frame_(layout().voxels(), 0),
      passed_in_frame_(layout().voxels(), 0) {}

void EgoStyleMap::castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                          bool is_return) {
  const VoxelIndex end_voxel = end.array().floor().cast<int>();
  observe(end_voxel, is_return);
  std::uint16_t& ended = ended_in_frame_[layout().indexOf(end_voxel)];
  if (ended == frame()) return;
  ended = frame();

  bool at_end = true;
  walkVoxels(end, origin, [&](const VoxelIndex& v) {
    if (at_end) {
      at_end = false;
      return true;
    }
    observe(v, false);
    std::uint16_t& passed = passed_in_frame_[layout().indexOf(v)];
    if (passed == frame()) return false;
    passed = frame();
    return true;
  });
}

}  // namespace fiimap::bench
