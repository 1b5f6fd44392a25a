#include "batch_inflater.h"

#include "obstacles.h"

namespace fiimap {

void BatchInflater::update(const ChangeSet& /*changes*/, SlidingGrid* grid) {
  grid->clearPlane(Plane::kInflated);
  for (const VoxelIndex& obstacle : obstaclesIn(grid->window(), *grid)) {
    for (const VoxelIndex& offset : element_.offsets()) {
      grid->set(Plane::kInflated, obstacle + offset, true);
    }
  }
}

}  // namespace fiimap
