#include "truth/inflation_truth.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "quantiles.h"
#include "truth/passed_voxels.h"
#include "truth/passing_margin.h"
#include "truth_report.h"

namespace fiimap {
namespace {

/// Calls visit(voxel, distance) for every voxel whose centre is within a radius (m) of a point.
template <typename Visitor>
void forEachWithin(double radius, const Eigen::Vector3d& point_W, const VoxelLattice& lattice,
                   Visitor&& visit) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const VoxelIndex low = lattice.indexOf(point_W - reach);
  const VoxelIndex high = lattice.indexOf(point_W + reach);
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        const double distance = (lattice.centerOf({x, y, z}) - point_W).norm();
        if (distance <= radius) visit(VoxelIndex(x, y, z), distance);
      }
    }
  }
}

}  // namespace

void InflationTruth::compare(const Snapshot& map, const ExactScene& scene,
                             const SeenSurface& surface, const VoxelBox& box, double time) {
  radius_ = map.info().inflation_radius;
  const VoxelBox inside = box.intersection(map.window());
  compareSafety(map, surface, inside);
  compareCost(map, scene, inside, time);
}

/// Every voxel whose centre is within the radius of a cell that was seen often must be inflated.
void InflationTruth::compareSafety(const Snapshot& map, const SeenSurface& surface,
                                   const VoxelBox& inside) {
  std::unordered_map<std::uint64_t, std::pair<VoxelIndex, double>> required;  // least distance
  surface.forEach([&](const Eigen::Vector3d& cell_W, int scans) {
    if (scans < TruthCount::kOften || !inside.contains(map.lattice().indexOf(cell_W))) return;
    forEachWithin(radius_, cell_W, map.lattice(), [&](const VoxelIndex& v, double distance) {
      if (!inside.contains(v)) return;
      double& least = required.try_emplace(keyOf(v), v, distance).first->second.second;
      least = std::min(least, distance);
    });
  });
  required_ += required.size();
  for (const auto& [key, voxel] : required) {
    if (map.inflation(voxel.first) == Inflation::kInflated) continue;
    ++missing_;
    least_clearance_ = std::min(least_clearance_, voxel.second);
  }
}

void InflationTruth::compareCost(const Snapshot& map, const ExactScene& scene,
                                 const VoxelBox& inside, double time) {
  for (const VoxelIndex& v : map.voxels(Plane::kInflated, inside)) {
    const Eigen::Vector3d center_W = map.lattice().centerOf(v);
    if (isNearPassing(scene, center_W, SeenSurface::kPassingMargin + radius_)) continue;
    ++inflated_;
    const double excess = scene.signedDistance(center_W, time) - radius_;
    if (excess > 0.0) excess_m_.push_back(excess);
  }
}

nlohmann::json InflationTruth::json() const {
  const auto share = [](std::size_t part, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / all;
  };
  const Quantiles excess = quantilesOf(excess_m_);
  return {
      {"radius", radius_},
      {"required", required_},
      {"missing_share", share(missing_, required_)},
      {"least_clearance_m", std::min(radius_, least_clearance_)},
      {"inflated", inflated_},
      {"excess_share", share(excess_m_.size(), inflated_)},
      {"excess_median_m", excess.median},
      {"excess_p95_m", excess.p95},
      {"excess_max_m", excess.max},
  };
}

}  // namespace fiimap
