#include "obstacles.h"

namespace fiimap {

std::vector<VoxelIndex> obstaclesIn(const VoxelBox& box, const SlidingGrid& grid) {
  std::vector<VoxelIndex> obstacles;
  grid.forEach(Plane::kOccupied, box, [&](const VoxelIndex& v) { obstacles.push_back(v); });
  return obstacles;
}

std::vector<VoxelIndex> obstaclesBeside(const std::vector<VoxelBox>& entered, int reach,
                                        const SlidingGrid& grid) {
  std::vector<VoxelIndex> obstacles;
  for (const VoxelBox& box : entered) {
    const VoxelBox wider{box.min.array() - reach, box.max.array() + reach};
    grid.forEach(Plane::kOccupied, wider, [&](const VoxelIndex& v) { obstacles.push_back(v); });
  }
  return obstacles;
}

}  // namespace fiimap
