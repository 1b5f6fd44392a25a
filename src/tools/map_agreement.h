#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baselines/octomap_map.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// How far our map and an OctoMap of the same scans say the same, voxel by voxel of our window.
struct MapAgreement {
  double resolution = 0.0;  ///< m
  /// voxels[ours][theirs], by Occupancy: unknown, free, occupied. Unknown to both is not counted.
  std::array<std::array<std::size_t, 3>, 3> voxels{};
  std::size_t ours_found = 0;    ///< our occupied voxels with one of theirs within one voxel (26)
  std::size_t theirs_found = 0;  ///< the other way round

  std::size_t ours(Occupancy state) const;
  std::size_t theirs(Occupancy state) const;
  /// Intersection over union of the voxels that either has in a state.
  double overlap(Occupancy state) const;
};

MapAgreement compareWithOctomap(const Snapshot& ours, const bench::OctomapMap& theirs);

/// Keys as documented in docs/evaluation.md.
nlohmann::json toJson(const MapAgreement& agreement);
/// For people.
std::string toText(const std::vector<MapAgreement>& agreements);

}  // namespace fiimap
