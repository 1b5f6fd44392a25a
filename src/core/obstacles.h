#pragma once

#include <vector>

#include "fiimap/sliding_grid.h"

namespace fiimap {

/// Occupied voxels of a box.
std::vector<VoxelIndex> obstaclesIn(const VoxelBox& box, const SlidingGrid& grid);

/// Occupied voxels that may inflate voxels of the boxes that have entered the window.
/// \param reach of the structuring element, voxels.
std::vector<VoxelIndex> obstaclesBeside(const std::vector<VoxelBox>& entered, int reach,
                                        const SlidingGrid& grid);

}  // namespace fiimap
