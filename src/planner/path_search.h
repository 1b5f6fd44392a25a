#pragma once

#include <cstdint>
#include <vector>

#include "flight_space.h"
#include "search_nodes.h"

namespace fiimap {

/// Where a path ends.
enum class PathEnd {
  kGoal,     ///< at the goal
  kBorder,   ///< on the way to a goal that is farther: at the border of the region
  kNearest,  ///< where it comes nearest to a goal that cannot be reached, or not with so much work
  kNowhere,  ///< the start is not free and there is no way out of where it is
};

/// Steps to the 26 neighbours have the lengths 1, sqrt(2) and sqrt(3) voxels rounded to a whole
/// number of this part of a voxel, so that sums are exact.
constexpr int kPathUnit = 10000;

struct VoxelPath {
  std::vector<VoxelIndex> voxels;  ///< from the start on, each a neighbour of the one before
  PathEnd end = PathEnd::kNowhere;
  std::size_t escape = 0;   ///< number of voxels at the beginning that are not free
  std::int64_t cost = 0;    ///< length from the first free voxel on, in 1/kPathUnit of a voxel
  std::size_t visited = 0;  ///< voxels that the search looked around from
};

/// Shortest path between 26-neighbours through free voxels (A*). A diagonal step needs all voxels
/// of the box around it free: no corner is cut. A start that is not free is left first, by the
/// shortest way to a free voxel that enters no occupied one. Keeps its memory from search to
/// search. Not thread-safe.
class PathSearch {
 public:
  /// \param max_visited the search ends after so many voxels, with the best path so far.
  explicit PathSearch(std::size_t max_visited);

  /// \param region what the search does not leave; it must hold the start and be less than 2^20
  /// voxels wide.
  /// \param max_escape how far away a free voxel may be when the start is not free, voxels.
  VoxelPath find(const FlightSpace& space, const VoxelIndex& start, const VoxelIndex& goal,
                 const VoxelBox& region, double max_escape);

  /// A rough way, over the middles of cubes of `stride` voxels: where to go in a large region, with
  /// a fraction of the work. Only these middles are looked at, so it may cut corners, cross what is
  /// thinner than a cube and miss what is narrower.
  /// \return the start, then middles of cubes, each a neighbour of the one before. No escape.
  VoxelPath findRoughly(const FlightSpace& space, const VoxelIndex& start, const VoxelIndex& goal,
                        const VoxelBox& region, int stride);

 private:
  /// Searches for a target, or for the border of the region on the way to it; fills in `path`.
  template <typename IsOpen>
  void searchFor(const VoxelIndex& start, const VoxelIndex& target, IsOpen&& is_open,
                 VoxelPath* path);
  template <typename IsOpen, typename Heuristic, typename IsEnd>
  bool run(const VoxelIndex& start, IsOpen&& is_open, Heuristic&& heuristic, IsEnd&& is_end);
  template <typename IsOpen, typename Heuristic>
  void expand(const SearchNodes::Node& node, IsOpen&& is_open, Heuristic&& heuristic);
  bool escape(const FlightSpace& space, const VoxelIndex& start, double max_escape,
              VoxelPath* path);
  /// Appends the way from the start of the last search to a voxel, without that voxel itself.
  void trace(const VoxelIndex& end, std::vector<VoxelIndex>* voxels) const;
  std::int64_t costOf(const VoxelIndex& v) const { return nodes_.find(v - region_.min)->cost; }

  std::size_t max_visited_;
  SearchNodes nodes_;
  VoxelBox region_;  ///< that the search does not leave
  // Of the last run.
  VoxelIndex end_ = VoxelIndex::Zero();      ///< where it ended
  VoxelIndex nearest_ = VoxelIndex::Zero();  ///< visited voxel with the least heuristic
  std::size_t visited_ = 0;
};

}  // namespace fiimap
