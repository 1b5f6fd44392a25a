#include "fiimap/inflater.h"

#include "batch_inflater.h"
#include "bfs_inflater.h"
#include "incremental_inflater.h"
#include "obstacles.h"

namespace fiimap {

std::unique_ptr<Inflater> makeInflater(const MapperConfig& config) {
  const StructuringElement element = config.structuringElement();
  switch (config.inflation_method) {
    case InflationMethod::kIncremental:
      return std::make_unique<IncrementalInflater>(element);
    case InflationMethod::kBfs:
      return std::make_unique<BfsInflater>(element, config.bfs_connectivity);
    case InflationMethod::kBatch:
      return std::make_unique<BatchInflater>(element);
  }
  return nullptr;
}

void rebuildInflation(Inflater* inflater, SlidingGrid* grid) {
  grid->clearPlane(Plane::kInflated);
  ChangeSet everything;
  everything.lower = obstaclesIn(grid->window(), *grid);
  inflater->update(everything, grid);
}

}  // namespace fiimap
