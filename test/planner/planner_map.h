#pragma once

#include <memory>
#include <set>
#include <vector>

#include "../core/oracle.h"
#include "fiimap/snapshot.h"
#include "flight_space.h"

namespace fiimap::test {

/// A map made by hand: everything is seen and free but for what is set. Inflated by a ball.
class PlannerMap {
 public:
  PlannerMap(const VoxelIndex& size, double resolution, double radius)
      : resolution_(resolution), grid_(size) {
    const StructuringElement element(ElementShape::kBall, radius, resolution);
    offsets_ = element.offsets();
    info_.resolution = resolution;
    info_.inflation_radius = radius;
    clear();
  }

  /// Everything is seen and free.
  void clear() {
    grid_.clear();
    forEachVoxel(grid_.window(), [&](const VoxelIndex& v) { grid_.set(Plane::kKnown, v, true); });
  }

  const VoxelBox& window() const { return grid_.window(); }
  double resolution() const { return resolution_; }
  VirtualWalls& walls() { return info_.walls; }

  void occupy(const VoxelIndex& v) {
    grid_.set(Plane::kOccupied, v, true);
    for (const VoxelIndex& offset : offsets_) {
      if (window().contains(v + offset)) grid_.set(Plane::kInflated, v + offset, true);
    }
  }
  void occupy(const VoxelBox& box) {
    forEachVoxel(box.intersection(window()), [&](const VoxelIndex& v) { occupy(v); });
  }
  void forget(const VoxelBox& box) {
    forEachVoxel(box.intersection(window()),
                 [&](const VoxelIndex& v) { grid_.set(Plane::kKnown, v, false); });
  }
  void moveTo(const VoxelIndex& min) {
    ChangeSet changes;
    grid_.moveTo(min, &changes);
  }

  std::shared_ptr<const Snapshot> snapshot() {
    ++info_.sequence;
    return std::make_shared<const Snapshot>(&grid_, info_);
  }
  FlightSpace space(const FlightRules& rules = {},
                    const Eigen::Vector3d& vehicle_W = Eigen::Vector3d::Zero()) {
    return {snapshot(), rules, vehicle_W};
  }

 private:
  double resolution_;
  SlidingGrid grid_;
  std::vector<VoxelIndex> offsets_;
  Snapshot::Info info_;
};

/// Pillars from floor to ceiling and some boxes, at random.
inline void scatter(Random& random, int pillars, int boxes, PlannerMap* map) {
  const VoxelBox& window = map->window();
  for (int i = 0; i < pillars; ++i) {
    const VoxelIndex at = uniformVoxel(random, window);
    map->occupy(
        VoxelBox{{at.x(), at.y(), window.min.z()}, {at.x() + 2, at.y() + 2, window.max.z()}});
  }
  for (int i = 0; i < boxes; ++i) {
    const VoxelIndex at = uniformVoxel(random, window);
    map->occupy(VoxelBox{at, at + VoxelIndex(4, 4, 4)});
  }
}

}  // namespace fiimap::test
