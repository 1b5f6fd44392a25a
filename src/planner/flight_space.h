#pragma once

#include <memory>

#include "fiimap/snapshot.h"

namespace fiimap {

/// Which layer of the map a flight must keep out of. Raw is for comparison: it knows no vehicle
/// size.
enum class FlightLayer { kInflated, kRaw };

/// What a place is taken for about which the map says nothing.
enum class Unseen { kObstacle, kFree };

struct FlightRules {
  FlightLayer layer = FlightLayer::kInflated;
  Unseen unknown = Unseen::kFree;
  Unseen outside = Unseen::kObstacle;  ///< of the window
};

/// Where a vehicle may fly according to one snapshot. Immutable; safe to share between threads.
class FlightSpace {
 public:
  /// \param snapshot not null.
  FlightSpace(std::shared_ptr<const Snapshot> snapshot, const FlightRules& rules);

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

  /// Whether a vehicle that is in a place which is not free may cross the voxel on its way out: the
  /// voxel itself is not occupied.
  bool isCrossable(const VoxelIndex& v) const;

  /// Whether all voxels that a straight line touches are free, also those that it touches in an
  /// edge or a corner only.
  bool isLineFree(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) const;

 private:
  std::shared_ptr<const Snapshot> snapshot_;
  FlightRules rules_;
  int lowest_, highest_;  ///< voxels that lie between the virtual walls with all of their height
};

}  // namespace fiimap
