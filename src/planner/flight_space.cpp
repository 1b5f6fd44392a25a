#include "flight_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fiimap/voxel_line.h"

namespace fiimap {
namespace {

/// Infinite walls are beyond all voxels.
int toHeight(double voxels) {
  constexpr double kLowest = std::numeric_limits<int>::min();
  constexpr double kHighest = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(voxels, kLowest, kHighest));
}

}  // namespace

FlightSpace::FlightSpace(std::shared_ptr<const Snapshot> snapshot, const FlightRules& rules,
                         const Eigen::Vector3d& vehicle_W)
    : snapshot_(std::move(snapshot)),
      rules_(rules),
      vehicle_(vehicle_W / resolution()),
      view_sine_(std::sin(rules.view_elevation)),
      view_cosine_(std::cos(rules.view_elevation)) {
  const VirtualWalls& walls = snapshot_->info().walls;
  constexpr double kRounding = 1e-9;  // voxels
  lowest_ = toHeight(std::ceil(walls.floor / resolution() - kRounding));
  highest_ = toHeight(std::floor(walls.ceiling / resolution() + kRounding) - 1.0);
}

bool FlightSpace::isFree(const VoxelIndex& v) const {
  if (v.z() < lowest_ || v.z() > highest_) return false;
  if (rules_.layer == MapLayer::kRaw) {
    switch (snapshot_->occupancy(v)) {
      case Occupancy::kFree:
        return true;
      case Occupancy::kUnknown:
        return isUnknownFree(v);
      case Occupancy::kOutside:
        return rules_.outside == Unseen::kFree;
      case Occupancy::kOccupied:
        return false;
    }
  }
  switch (snapshot_->inflation(v)) {
    case Inflation::kFree:
      return true;
    case Inflation::kUnknown:
      return isUnknownFree(v);
    case Inflation::kOutside:
      return rules_.outside == Unseen::kFree;
    case Inflation::kInflated:
      return false;
  }
  return false;
}

bool FlightSpace::isUnknownFree(const VoxelIndex& v) const {
  constexpr double kLevel = 1.5;      // voxels of climb that count as none
  constexpr double kRounding = 1e-6;  // voxels; at an elevation of pi/2 everything is seen
  if (rules_.unknown == Unseen::kObstacle) return false;
  const Eigen::Vector3d offset = (v.cast<double>().array() + 0.5).matrix() - vehicle_;
  const double climb = std::max(0.0, std::abs(offset.z()) - kLevel);
  return climb * view_cosine_ <= offset.head<2>().norm() * view_sine_ + kRounding;
}

bool FlightSpace::isFree(const Eigen::Vector3d& point_W) const {
  return lattice().canIndex(point_W) && isFree(lattice().indexOf(point_W));
}

bool FlightSpace::isUnseen(const Eigen::Vector3d& point_W) const {
  return rules_.layer == MapLayer::kRaw ? snapshot_->occupancy(point_W) == Occupancy::kUnknown
                                        : snapshot_->inflation(point_W) == Inflation::kUnknown;
}

bool FlightSpace::isCrossable(const VoxelIndex& v) const {
  const Occupancy occupancy = snapshot_->occupancy(v);
  if (occupancy == Occupancy::kOutside) return rules_.outside == Unseen::kFree;
  return occupancy != Occupancy::kOccupied;
}

bool FlightSpace::isLineFree(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) const {
  if (!lattice().canIndex(from_W) || !lattice().canIndex(to_W)) return false;
  return forEachVoxelOnLine(lattice().toVoxels(from_W), lattice().toVoxels(to_W),
                            [this](const VoxelIndex& v, double, double) { return isFree(v); });
}

}  // namespace fiimap
