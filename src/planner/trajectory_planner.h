#pragma once

#include <optional>
#include <vector>

#include "guide_path.h"
#include "path_search.h"
#include "planner_config.h"
#include "trajectory.h"

namespace fiimap {

/// A plan that may be flown: it begins in the given state, ends at rest, holds the limits, and is
/// free all along (but for the way out of a start that is not).
struct Plan {
  std::optional<Trajectory> trajectory;  ///< none: there is no plan
  PathEnd end = PathEnd::kNowhere;       ///< what the path found
  std::vector<Eigen::Vector3d> path;     ///< the path with its shortcuts, m
  std::size_t visited = 0;               ///< voxels that the search visited
};

/// From a place and a goal to a trajectory, on one snapshot. Keeps its memory from plan to plan.
/// Not thread-safe.
class TrajectoryPlanner {
 public:
  explicit TrajectoryPlanner(const PlannerConfig& config);

  /// \param start state at start_time; a speed or acceleration beyond the limits is the limit of
  /// this plan. \param goal metres, map frame; finite.
  Plan plan(const FlightSpace& space, const MotionState& start, double start_time,
            const Eigen::Vector3d& goal);

 private:
  VoxelBox regionAround(const FlightSpace& space, const VoxelIndex& start) const;
  std::optional<Bspline> fly(const FlightSpace& space, const MotionState& start,
                             const Polyline& way, double speed_factor, bool smooth) const;
  /// Whether a curve may be flown from a state.
  bool isAccepted(const FlightSpace& space, const Bspline& curve, const MotionState& start) const;

  PlannerConfig config_;
  PathSearch search_;
};

}  // namespace fiimap
