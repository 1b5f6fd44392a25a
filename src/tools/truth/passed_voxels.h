#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "exact_scene.h"
#include "fiimap/range_data.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// One number for a voxel within 2^20 of the origin.
inline std::uint64_t keyOf(const VoxelIndex& v) {
  constexpr std::int64_t kOffset = 1 << 20;
  constexpr int kBits = 21;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kOffset); };
  return (part(v.x()) << (2 * kBits)) | (part(v.y()) << kBits) | part(v.z());
}

/// Free space of the exact scene that a map should know, and how much of it it knows.
struct FreeSpaceCount {
  std::size_t free = 0;      ///< voxels that rays passed and no surface crosses
  std::size_t found = 0;     ///< of these: free in the map
  std::size_t occupied = 0;  ///< of these: occupied in the map
};

/// Remembers which voxels the exact rays of a sensor passed, wherever noise put their returns.
class PassedVoxels {
 public:
  /// Of the rays with a return, every n-th is followed.
  static constexpr std::size_t kEveryReturn = 16;

  /// \param resolution m; \param max_range where rays end at the latest, m.
  PassedVoxels(double resolution, double max_range) : lattice_(resolution), max_range_(max_range) {}

  /// Follows rays up to the exact surface, not into its voxel. \param time of the scene, s.
  void add(const RangeData& scan, const ExactScene& scene, double time);
  bool passed(const VoxelIndex& v) const { return ever_.count(keyOf(v)) > 0; }

  /// Adds one moment: the voxels of a box that no surface crosses, but near what comes and goes.
  void compare(const Snapshot& map, const ExactScene& scene, const VoxelBox& box, double time,
               FreeSpaceCount* count) const;

 private:
  VoxelLattice lattice_;
  double max_range_;
  std::vector<VoxelIndex> passed_;  // each once
  std::unordered_set<std::uint64_t> ever_;
};

}  // namespace fiimap
