#pragma once

#include "array_map.h"

namespace fiimap::bench {

/// Mapping in the manner of ego-planner's grid map: one ray per distinct end voxel, walked from its
/// end to the camera and stopped at the first voxel that another ray of the frame has passed; a
/// voxel is hit when at least half of its observations are hits. Written from the description.
class EgoStyleMap : public ArrayMap {
 public:
  EgoStyleMap(const MapperConfig& config, const VoxelBox& box);

 protected:
  void castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, bool is_return) override;
  bool isHit(std::uint16_t hits, std::uint16_t observations) const override {
    return 2 * hits >= observations;
  }

 private:
  std::vector<std::uint16_t> ended_in_frame_;
  std::vector<std::uint16_t> passed_in_frame_;
};

}  // namespace fiimap::bench
