#include "fiimap/snapshot.h"

#include <algorithm>

#include "fiimap/voxel_line.h"

namespace fiimap {
namespace {

/// Of both layers, which are alike. A sum, since a planner's questions make branches guess wrong.
constexpr int codeOf(bool obstacle, bool known) { return (known | obstacle) + obstacle; }
static_assert(codeOf(true, true) == static_cast<int>(Occupancy::kOccupied) &&
              codeOf(true, false) == static_cast<int>(Inflation::kInflated) &&
              codeOf(false, true) == static_cast<int>(Occupancy::kFree) &&
              codeOf(false, true) == static_cast<int>(Inflation::kFree) &&
              codeOf(false, false) == static_cast<int>(Occupancy::kUnknown) &&
              codeOf(false, false) == static_cast<int>(Inflation::kUnknown));

}  // namespace

Snapshot::Snapshot(SlidingGrid* grid, const Info& info)
    : info_(info),
      lattice_(info.resolution),
      bounds_(grid->window()),
      layout_(grid->layout()),
      ring_(grid->ring()),
      tiles_(grid->shareTiles()) {
  info_.window = grid->window();
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    counts_[static_cast<int>(plane)] = grid->count(plane);
  }
}

// Inline: other functions of a shared library are called through a table, by itself too. Without
// that, and with the bounds as numbers, a query takes 13 ns instead of 17.

inline bool Snapshot::test(const std::uint64_t* tile, Plane plane, const VoxelIndex& v) const {
  const unsigned bit = layout_.bitOf(v.z());
  const std::uint64_t* const words = tile + offsetInTile(plane, v.x(), v.y(), layout_);
  return ((words[bit / kWordBits] >> (bit % kWordBits)) & 1u) != 0;
}

inline Occupancy Snapshot::measuredOccupancy(const VoxelIndex& v) const {
  const std::uint64_t* const tile = tileAt(v.x(), v.y());
  if (tile == nullptr) return Occupancy::kUnknown;
  return static_cast<Occupancy>(
      codeOf(test(tile, Plane::kOccupied, v), test(tile, Plane::kKnown, v)));
}

inline Inflation Snapshot::measuredInflation(const VoxelIndex& v) const {
  const std::uint64_t* const tile = tileAt(v.x(), v.y());
  if (tile == nullptr) return Inflation::kUnknown;
  return static_cast<Inflation>(
      codeOf(test(tile, Plane::kInflated, v), test(tile, Plane::kKnown, v)));
}

Occupancy Snapshot::occupancy(const VoxelIndex& v) const {
  if (!window().contains(v)) return Occupancy::kOutside;
  return beyondWalls(lattice_.centerOf(v).z()) ? Occupancy::kOccupied : measuredOccupancy(v);
}

Occupancy Snapshot::occupancy(const Eigen::Vector3d& point_W) const {
  VoxelIndex v;
  if (!lattice_.indexIn(bounds_, point_W, &v)) return Occupancy::kOutside;
  return beyondWalls(point_W.z()) ? Occupancy::kOccupied : measuredOccupancy(v);
}

Inflation Snapshot::inflation(const VoxelIndex& v) const {
  if (!window().contains(v)) return Inflation::kOutside;
  return beyondWalls(lattice_.centerOf(v).z()) ? Inflation::kInflated : measuredInflation(v);
}

Inflation Snapshot::inflation(const Eigen::Vector3d& point_W) const {
  VoxelIndex v;
  if (!lattice_.indexIn(bounds_, point_W, &v)) return Inflation::kOutside;
  return beyondWalls(point_W.z()) ? Inflation::kInflated : measuredInflation(v);
}

bool Snapshot::isObstacle(const VoxelIndex& v, const ObstacleRules& rules) const {
  const bool is_raw = rules.layer == MapLayer::kRaw;
  // The codes of both layers are alike.
  switch (is_raw ? occupancy(v) : static_cast<Occupancy>(inflation(v))) {
    case Occupancy::kUnknown:
      return rules.unknown == Unseen::kObstacle;
    case Occupancy::kFree:
      return false;
    case Occupancy::kOccupied:
      return true;
    case Occupancy::kOutside:
      break;
  }
  return rules.outside == Unseen::kObstacle;
}

std::optional<RayHit> Snapshot::castRay(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                        const ObstacleRules& rules) const {
  if (!lattice_.canIndex(from_W) || !lattice_.canIndex(to_W)) {
    return RayHit{window().max, from_W, 0.0};
  }
  std::optional<RayHit> hit;
  forEachVoxelOnLine(lattice_.toVoxels(from_W), lattice_.toVoxels(to_W),
                     [&](const VoxelIndex& v, double t_in, double /*t_out*/) {
                       if (!isObstacle(v, rules)) return true;
                       const Eigen::Vector3d way = t_in * (to_W - from_W);
                       hit = RayHit{v, from_W + way, way.norm()};
                       return false;
                     });
  return hit;
}

bool Snapshot::lineOfSight(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W,
                           const ObstacleRules& rules) const {
  // Always from the same end, so that rounding is the same.
  const bool a_is_first =
      std::lexicographical_compare(a_W.data(), a_W.data() + 3, b_W.data(), b_W.data() + 3);
  return !castRay(a_is_first ? a_W : b_W, a_is_first ? b_W : a_W, rules);
}

std::vector<VoxelIndex> Snapshot::voxels(Plane plane, const VoxelBox& box) const {
  std::vector<VoxelIndex> found;
  const VoxelBox inside = box.intersection(window());
  for (int x = inside.min.x(); x < inside.max.x(); ++x) {
    for (int y = inside.min.y(); y < inside.max.y(); ++y) {
      const std::uint64_t* const tile = tileAt(x, y);
      if (tile == nullptr) {
        y |= kTileSide - 1;  // nothing was ever seen in this tile
        continue;
      }
      forEachBit(tile + offsetInTile(plane, x, y, layout_), layout_.words(), [&](int bit) {
        const int z = layout_.heightOf(bit, window().min.z());
        if (z >= inside.min.z() && z < inside.max.z()) found.emplace_back(x, y, z);
      });
    }
  }
  return found;
}

}  // namespace fiimap
