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

  /// Straight on to rest, whatever is there.
  Trajectory stop(const MotionState& start, double start_time) const;

 private:
  VoxelBox regionAround(const FlightSpace& space, const VoxelIndex& start) const;
  /// The first planning_horizon of the way to a goal: a rough search of the whole window says where
  /// it leads, so that no dead end of the window holds the vehicle, and a fine one finds it.
  VoxelPath findPath(const FlightSpace& space, const VoxelIndex& start, const VoxelIndex& goal);
  /// Control points along a way, from a state to rest, at the times of a speed profile.
  Bspline along(const Polyline& way, const SpeedProfile& profile, const MotionState& start) const;
  Bspline guideAlong(const Polyline& way, const MotionState& start, double speed_factor) const;
  /// \param way with shortcuts; \param safe_way without.
  std::optional<Bspline> fly(const FlightSpace& space, const MotionState& start,
                             const Polyline& way, const Polyline& safe_way) const;
  /// The last resort: slowly from voxel to voxel; the slower, the nearer to a way that is free.
  /// From rest there always is such a curve.
  std::optional<Bspline> crawl(const FlightSpace& space, const MotionState& start,
                               const Polyline& safe_way) const;
  /// The share of its speed at which a curve would hold the limits; >= 1: it does.
  double slowdown(const Bspline& curve, const MotionState& start) const;

  PlannerConfig config_;
  PathSearch search_;
};

}  // namespace fiimap
