#pragma once

#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "exact_scene.h"
#include "fiimap/snapshot.h"
#include "seen_surface.h"

namespace fiimap {

/// The inflated layer against the exact obstacles dilated by a ball of the inflation radius.
class InflationTruth {
 public:
  /// Adds one moment: the voxels of a box, but near what comes, goes or moves.
  void compare(const Snapshot& map, const ExactScene& scene, const SeenSurface& surface,
               const VoxelBox& box, double time);

  /// Keys as documented in docs/evaluation.md.
  nlohmann::json json() const;

 private:
  void compareSafety(const Snapshot& map, const SeenSurface& surface, const VoxelBox& inside);
  void compareCost(const Snapshot& map, const ExactScene& scene, const VoxelBox& inside,
                   double time);

  double radius_ = 0.0;       // m
  std::size_t required_ = 0;  // voxels within the radius of surface that was seen often
  std::size_t missing_ = 0;   // of these: not inflated
  double least_clearance_ = std::numeric_limits<double>::infinity();  // of those missing, m
  std::size_t inflated_ = 0;
  std::vector<double> excess_m_;  // of voxels beyond the radius: how far
};

}  // namespace fiimap
