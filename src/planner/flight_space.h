#pragma once

#include <memory>

#include "fiimap/snapshot.h"

namespace fiimap {

/// By default unseen places are free where a camera looks that is fixed to the vehicle.
struct FlightRules {
  /// That a flight must keep out of. Raw is for comparison: it knows no vehicle size.
  MapLayer layer = MapLayer::kInflated;
  Unseen unknown = Unseen::kFree;
  Unseen outside = Unseen::kObstacle;  ///< of the window
  /// With unknown = kFree: rad above and below the vehicle's horizon beyond which a place that was
  /// not seen is an obstacle all the same, because the vehicle would get there before its sensor
  /// sees it. pi/2: none is.
  double view_elevation = 0.35;
};

/// Where a vehicle may fly according to one snapshot and its place. Immutable; safe to share
/// between threads.
class FlightSpace {
 public:
  /// \param snapshot not null. \param vehicle_W where the vehicle is, m: from there it sees.
  FlightSpace(std::shared_ptr<const Snapshot> snapshot, const FlightRules& rules,
              const Eigen::Vector3d& vehicle_W);

  const Snapshot& snapshot() const { return *snapshot_; }
  const VoxelLattice& lattice() const { return snapshot_->lattice(); }
  double resolution() const { return lattice().resolution(); }
  /// Whether places outside of the window are obstacles.
  bool endsAtWindow() const { return rules_.outside == Unseen::kObstacle; }

  /// Whether a vehicle may be there by plan. A voxel that a virtual wall cuts is not free.
  bool isFree(const VoxelIndex& v) const;
  /// The same for the voxel at a point (metres, map frame); points that are not finite are not
  /// free.
  bool isFree(const Eigen::Vector3d& point_W) const;

  /// Whether nothing is known of the voxel at a point.
  bool isUnseen(const Eigen::Vector3d& point_W) const;

  /// Whether a vehicle that is in a place which is not free may cross the voxel on its way out: the
  /// voxel itself is not occupied.
  bool isCrossable(const VoxelIndex& v) const;

  /// Whether all voxels that a straight line touches are free, also those that it touches in an
  /// edge or a corner only.
  bool isLineFree(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) const;

 private:
  bool isUnknownFree(const VoxelIndex& v) const;

  std::shared_ptr<const Snapshot> snapshot_;
  FlightRules rules_;
  Eigen::Vector3d vehicle_;         ///< voxels
  double view_sine_, view_cosine_;  ///< of the elevation
  int lowest_, highest_;  ///< voxels that lie between the virtual walls with all of their height
};

}  // namespace fiimap
