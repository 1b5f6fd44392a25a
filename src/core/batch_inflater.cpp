#include "batch_inflater.h"

#include <vector>

namespace fiimap {

void BatchInflater::update(const ChangeSet& /*changes*/, SlidingGrid* grid) {
  grid->clearPlane(Plane::kInflated);
  // Collected first, because setting bits may add tiles to the grid.
  std::vector<VoxelIndex> obstacles;
  grid->forEach(Plane::kOccupied, [&](const VoxelIndex& v) { obstacles.push_back(v); });
  for (const VoxelIndex& obstacle : obstacles) {
    for (const VoxelIndex& offset : element_.offsets()) {
      grid->set(Plane::kInflated, obstacle + offset, true);
    }
  }
}

}  // namespace fiimap
