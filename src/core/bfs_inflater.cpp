#include "bfs_inflater.h"

#include <algorithm>

#include "obstacles.h"

namespace fiimap {
namespace {

std::vector<VoxelIndex> makeNeighbours(int connectivity) {
  // Neighbours that differ on one axis, on at most two, on at most three.
  const int max_axes = connectivity == 6 ? 1 : connectivity == 18 ? 2 : 3;
  std::vector<VoxelIndex> neighbours;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const VoxelIndex offset(dx, dy, dz);
        const int axes = offset.cwiseAbs().sum();
        if (axes > 0 && axes <= max_axes) neighbours.push_back(offset);
      }
    }
  }
  return neighbours;
}

}  // namespace

BfsInflater::Region::Region(int reach)
    : reach_(reach), flags_((2 * reach + 1) * (2 * reach + 1) * (2 * reach + 1), 0) {}

std::size_t BfsInflater::Region::indexOf(const VoxelIndex& offset) const {
  const int side = 2 * reach_ + 1;
  return (static_cast<std::size_t>(offset.x() + reach_) * side + offset.y() + reach_) * side +
         offset.z() + reach_;
}

BfsInflater::BfsInflater(const StructuringElement& element, int connectivity)
    : neighbours_(makeNeighbours(connectivity)),
      element_(element.reach()),
      doubled_element_(2 * element.reach()) {
  for (const VoxelIndex& offset : element.offsets()) element_.insert(offset);
  insertDoubled(element);
  visited_.resize(doubled_element_.cells());
}

/// Columns of E are convex, so those of E + E are, too: as high as the highest sum of two.
void BfsInflater::insertDoubled(const StructuringElement& element) {
  const int reach = element.reach();
  for (int x = -2 * reach; x <= 2 * reach; ++x) {
    for (int y = -2 * reach; y <= 2 * reach; ++y) {
      int half_height = -1;
      for (int dx = -reach; dx <= reach; ++dx) {
        for (int dy = -reach; dy <= reach; ++dy) {
          const int a = element.halfHeight(dx, dy);
          const int b = element.halfHeight(x - dx, y - dy);
          if (a >= 0 && b >= 0) half_height = std::max(half_height, a + b);
        }
      }
      for (int z = -half_height; half_height >= 0 && z <= half_height; ++z) {
        doubled_element_.insert({x, y, z});
      }
    }
  }
}

void BfsInflater::update(const ChangeSet& changes, SlidingGrid* grid) {
  lower_ = obstaclesBeside(changes.entered, element_.reach(), *grid);
  lower_.insert(lower_.end(), changes.lower.begin(), changes.lower.end());
  for (const VoxelIndex& v : changes.raise) raise(v, grid);
  for (const VoxelIndex& v : changes.forgotten) raise(v, grid);
  std::sort(lower_.begin(), lower_.end(), [](const VoxelIndex& a, const VoxelIndex& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  lower_.erase(std::unique(lower_.begin(), lower_.end()), lower_.end());
  for (const VoxelIndex& v : lower_) {
    search(element_,
           [&](const VoxelIndex& offset) { grid->set(Plane::kInflated, v + offset, true); });
  }
}

void BfsInflater::raise(const VoxelIndex& source, SlidingGrid* grid) {
  search(doubled_element_, [&](const VoxelIndex& offset) {
    const VoxelIndex v = source + offset;
    if (element_.contains(offset)) grid->set(Plane::kInflated, v, false);
    if (grid->test(Plane::kOccupied, v)) lower_.push_back(v);
  });
}

template <typename Visitor>
void BfsInflater::search(const Region& region, Visitor&& visit) {
  std::fill_n(visited_.begin(), region.cells(), 0);
  queue_.assign(1, VoxelIndex::Zero());
  visited_[region.indexOf(VoxelIndex::Zero())] = 1;
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const VoxelIndex offset = queue_[next];
    visit(offset);
    for (const VoxelIndex& neighbour : neighbours_) {
      const VoxelIndex reached = offset + neighbour;
      if (!region.contains(reached)) continue;
      std::uint8_t& visited = visited_[region.indexOf(reached)];
      if (visited != 0) continue;
      visited = 1;
      queue_.push_back(reached);
    }
  }
}

}  // namespace fiimap
