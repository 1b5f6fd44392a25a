#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exact_scene.h"
#include "fiimap/snapshot.h"
#include "seen_surface.h"
#include "truth/inflation_truth.h"
#include "truth/passed_voxels.h"

namespace fiimap {

/// How a map compares with the exact scene, summed over the moments at which it was compared.
/// docs/evaluation.md defines the shares.
struct TruthCount {
  std::size_t snapshots = 0;
  std::size_t occupied = 0;  ///< occupied voxels, but near what comes, goes or moves
  std::size_t off = 0;       ///< of these: the surface cannot cross the voxel
  std::size_t seen = 0;      ///< surface cells seen by a scan so far
  std::size_t seen_found = 0;
  std::size_t often = 0;  ///< by at least kOften scans
  std::size_t often_found = 0;
  std::size_t leftover = 0;  ///< voxels still occupied where something passed

  double half() const { return share(off, occupied); }
  double recallOften() const { return share(often_found, often); }
  double recallAny() const { return share(seen_found, seen); }

  static constexpr int kOften = 5;

 private:
  static double share(std::size_t part, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / all;
  }
};

/// Adds one moment: the voxels of a box around the sensor, as far as they are in the map's window.
/// \param time of the scene, s.
void compareWithScene(const Snapshot& map, const ExactScene& scene, const SeenSurface& surface,
                      const VoxelBox& box, double time, TruthCount* count);

/// All that is compared at one resolution.
struct TruthRow {
  double resolution = 0.0;  ///< m
  TruthCount count;
  FreeSpaceCount free_space;
  InflationTruth inflation;
  nlohmann::json obstacles;  ///< those that come and go: PassingObstacles::json()
};

/// Keys as documented in README.md.
nlohmann::json toJson(const TruthRow& row);
/// The table for people, or as CSV.
std::string toText(const std::vector<TruthRow>& rows, bool csv);

}  // namespace fiimap
