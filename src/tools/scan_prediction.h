#pragma once

#include <cstddef>
#include <functional>

#include "fiimap/range_data.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// How well a map foretells a scan that it was not built from.
struct ScanPrediction {
  std::size_t rays = 0;     ///< rays with a return
  std::size_t hits = 0;     ///< their end point is in an occupied voxel
  std::size_t near = 0;     ///< that voxel or one of its 26 neighbours is occupied
  std::size_t blocked = 0;  ///< the ray leaves an occupied voxel well before its end
  std::size_t outside = 0;  ///< the end point is outside of the map's window: no hit
};

/// A ray is blocked when it leaves an occupied voxel more than this many voxel edges before its
/// end.
constexpr double kBlockedBeforeEnd = 2.0;

/// What a map says of a voxel; kOutside where it has none.
using OccupancyQuery = std::function<Occupancy(const VoxelIndex&)>;

/// Compares the returns of a scan with the occupied voxels of a map. Every voxel of the exact line
/// from the origin to the end point is looked at.
ScanPrediction predict(const OccupancyQuery& map, const VoxelLattice& lattice,
                       const RangeData& scan);
ScanPrediction predict(const Snapshot& map, const RangeData& scan);

}  // namespace fiimap
