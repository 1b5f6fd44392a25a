#include "fiimap/snapshot.h"

namespace fiimap {

Snapshot::Snapshot(SlidingGrid* grid, const Info& info)
    : info_(info),
      lattice_(info.resolution),
      layout_(grid->layout()),
      ring_(grid->ring()),
      tiles_(grid->shareTiles()) {
  info_.window = grid->window();
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    counts_[static_cast<int>(plane)] = grid->count(plane);
  }
}

Occupancy Snapshot::occupancy(const VoxelIndex& v) const {
  if (!window().contains(v)) return Occupancy::kOutside;
  return beyondWalls(lattice_.centerOf(v).z()) ? Occupancy::kOccupied : measuredOccupancy(v);
}

Occupancy Snapshot::occupancy(const Eigen::Vector3d& point_W) const {
  if (!lattice_.canIndex(point_W)) return Occupancy::kOutside;
  const VoxelIndex v = lattice_.indexOf(point_W);
  if (!window().contains(v)) return Occupancy::kOutside;
  return beyondWalls(point_W.z()) ? Occupancy::kOccupied : measuredOccupancy(v);
}

Inflation Snapshot::inflation(const VoxelIndex& v) const {
  if (!window().contains(v)) return Inflation::kOutside;
  return beyondWalls(lattice_.centerOf(v).z()) ? Inflation::kInflated : measuredInflation(v);
}

Inflation Snapshot::inflation(const Eigen::Vector3d& point_W) const {
  if (!lattice_.canIndex(point_W)) return Inflation::kOutside;
  const VoxelIndex v = lattice_.indexOf(point_W);
  if (!window().contains(v)) return Inflation::kOutside;
  return beyondWalls(point_W.z()) ? Inflation::kInflated : measuredInflation(v);
}

Occupancy Snapshot::measuredOccupancy(const VoxelIndex& v) const {
  if (test(Plane::kOccupied, v)) return Occupancy::kOccupied;
  return test(Plane::kKnown, v) ? Occupancy::kFree : Occupancy::kUnknown;
}

Inflation Snapshot::measuredInflation(const VoxelIndex& v) const {
  if (test(Plane::kInflated, v)) return Inflation::kInflated;
  return test(Plane::kKnown, v) ? Inflation::kFree : Inflation::kUnknown;
}

bool Snapshot::test(Plane plane, const VoxelIndex& v) const {
  const std::uint64_t* words = column(plane, v.x(), v.y());
  const int bit = layout_.bitOf(v.z());
  return words != nullptr && ((words[bit / kWordBits] >> (bit % kWordBits)) & 1u) != 0;
}

const std::uint64_t* Snapshot::column(Plane plane, int x, int y) const {
  const Tile* tile = tiles_[ring_.slotOf(x, y)].get();
  return tile == nullptr ? nullptr : tile->column(plane, x, y, layout_);
}

std::vector<VoxelIndex> Snapshot::voxels(Plane plane, const VoxelBox& box) const {
  std::vector<VoxelIndex> found;
  const VoxelBox inside = box.intersection(window());
  for (int x = inside.min.x(); x < inside.max.x(); ++x) {
    for (int y = inside.min.y(); y < inside.max.y(); ++y) {
      const std::uint64_t* words = column(plane, x, y);
      if (words == nullptr) {
        y |= kTileSide - 1;  // nothing was ever seen in this tile
        continue;
      }
      forEachBit(words, layout_.words(), [&](int bit) {
        const int z = layout_.heightOf(bit, window().min.z());
        if (z >= inside.min.z() && z < inside.max.z()) found.emplace_back(x, y, z);
      });
    }
  }
  return found;
}

}  // namespace fiimap
