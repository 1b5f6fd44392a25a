#include "trajectory_planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trajectory_optimizer.h"

namespace fiimap {
namespace {

constexpr double kSpeedPart = 0.9;         // of the limit, to fly with; the rest is for turns
constexpr double kAccelerationPart = 0.6;  // of the limit, for speeding up; likewise
constexpr double kBrakingPart = 0.8;       // of the limit, for a stop that is smoothed later
constexpr double kRounding = 1e-6;         // share by which a limit may be exceeded
constexpr int kRestKnots = 2;              // added to come to rest smoothly
// Ever slower, until limits and obstacles allow it.
constexpr int kAttempts = 4;
constexpr double kSlower = 0.65, kMuchSlower = 0.4;  // share of the speed for the next attempt
constexpr double kSlowest = 0.2;
constexpr double kCrawlSlower = 0.5;

constexpr double kGuideStep = 0.3;  // m; vehicles need more room than that

/// The last voxel of a path up to a length, voxels.
std::size_t lastWithin(const std::vector<VoxelIndex>& path, double length) {
  std::size_t last = 0;
  for (double way = 0.0; last + 1 < path.size(); ++last) {
    way += (path[last + 1] - path[last]).cast<double>().norm();
    if (way > length) break;
  }
  return last;
}

/// Whether a curve that holds the limits at a share of its speed can be flown from a state: all of
/// it slower only from rest, which is the same at any speed.
bool canBeFlown(double share, const MotionState& start) {
  return share >= 1.0 || (start.velocity.isZero() && start.acceleration.isZero());
}

/// The same curve at a share of its speed, but no faster than it is.
Bspline slowed(const Bspline& curve, double share) {
  return {curve.control(), curve.interval() / std::min(1.0, share)};
}

/// Speed towards the beginning of a way.
double speedAlong(const MotionState& start, const Polyline& way) {
  constexpr double kLook = 0.5;  // m
  const Eigen::Vector3d ahead = way.at(kLook) - start.position;
  return ahead.norm() > 0.0 ? std::max(0.0, start.velocity.dot(ahead.normalized())) : 0.0;
}

}  // namespace

TrajectoryPlanner::TrajectoryPlanner(const PlannerConfig& config)
    : config_(config), search_(static_cast<std::size_t>(config.max_visited)) {}

Plan TrajectoryPlanner::plan(const FlightSpace& space, const MotionState& start, double start_time,
                             const Eigen::Vector3d& goal) {
  Plan plan;
  const VoxelLattice& lattice = space.lattice();
  if (!lattice.canIndex(start.position) || !lattice.canIndex(goal)) return plan;
  const VoxelIndex first = lattice.indexOf(start.position);
  if (space.endsAtWindow() && !space.snapshot().window().contains(first)) return plan;

  const VoxelPath path = findPath(space, first, lattice.indexOf(goal));
  plan.end = path.end;
  plan.visited = path.visited;
  if (path.end == PathEnd::kNowhere) return plan;

  const Eigen::Vector3d end =
      path.end == PathEnd::kGoal ? goal : lattice.centerOf(path.voxels.back());
  const Polyline through = throughCenters(path, start.position, end, lattice);
  // The way out stays as it was found: its first free point is behind the start and the way's
  // voxels.
  const std::size_t kept = path.escape > 0 ? path.escape + 2 : 1;
  const Polyline way = shortcut(through, space, kept);
  plan.path = way.points();
  std::optional<Bspline> curve = fly(space, start, way, through);
  if (curve) plan.trajectory.emplace(*std::move(curve), start_time);
  return plan;
}

Trajectory TrajectoryPlanner::stop(const MotionState& start, double start_time) const {
  const double speed = start.velocity.norm();
  const double deceleration = kBrakingPart * config_.max_braking;
  const double length = speed * speed / (2.0 * deceleration);
  const Polyline way({start.position, start.position + length * start.velocity.stableNormalized()});
  return {along(way, {length, speed, speed, deceleration}, start), start_time};
}

VoxelBox TrajectoryPlanner::regionAround(const FlightSpace& space, const VoxelIndex& start) const {
  const int reach = static_cast<int>(std::ceil(config_.planning_horizon / space.resolution()));
  const VoxelBox region{start.array() - reach, start.array() + reach + 1};
  return space.endsAtWindow() ? region.intersection(space.snapshot().window()) : region;
}

VoxelPath TrajectoryPlanner::findPath(const FlightSpace& space, const VoxelIndex& start,
                                      const VoxelIndex& goal) {
  const double max_escape = config_.max_escape / space.resolution();
  const VoxelBox region = regionAround(space, start);
  const int stride = std::max(1, static_cast<int>(std::lround(kGuideStep / space.resolution())));
  const VoxelPath guide = search_.findRoughly(
      space, start, goal, space.endsAtWindow() ? space.snapshot().window() : region, stride);
  const bool is_guided = guide.end == PathEnd::kGoal || guide.end == PathEnd::kBorder;
  if (!is_guided) {
    // Perhaps there is a way that is narrower than the guide's cubes.
    VoxelPath direct = search_.find(space, start, goal, region, max_escape);
    const bool leads_on = direct.end == PathEnd::kGoal || direct.end == PathEnd::kBorder;
    if (leads_on || guide.voxels.size() < 2) return direct;
  }
  const std::size_t last = lastWithin(guide.voxels, config_.planning_horizon / space.resolution());
  const bool to_goal = guide.end == PathEnd::kGoal && last + 1 == guide.voxels.size();
  VoxelPath path =
      search_.find(space, start, to_goal ? goal : guide.voxels[last], region, max_escape);
  if (path.end == PathEnd::kGoal && !to_goal) {
    path.end = is_guided ? PathEnd::kBorder : PathEnd::kNearest;
  }
  path.visited += guide.visited;
  return path;
}

Bspline TrajectoryPlanner::along(const Polyline& way, const SpeedProfile& profile,
                                 const MotionState& start) const {
  const double interval = config_.knot_interval;
  const int segments = std::max(
      Bspline::kDegree, static_cast<int>(std::ceil(profile.duration() / interval)) + kRestKnots);
  Bspline::Points control = Bspline::controlOf(start, interval);
  // The second control point belongs to the start, the one before the last to the end.
  for (int i = Bspline::kDegree; i < segments; ++i) {
    control.push_back(way.at(profile.at((i - 1) * interval)));
  }
  for (int i = 0; i < Bspline::kDegree; ++i) control.push_back(way.points().back());
  return {std::move(control), interval};
}

Bspline TrajectoryPlanner::guideAlong(const Polyline& way, const MotionState& start,
                                      double speed_factor) const {
  const SpeedProfile profile(way.length(), speedAlong(start, way),
                             speed_factor * kSpeedPart * config_.max_speed,
                             kAccelerationPart * config_.max_acceleration);
  return along(way, profile, start);
}

std::optional<Bspline> TrajectoryPlanner::fly(const FlightSpace& space, const MotionState& start,
                                              const Polyline& way, const Polyline& safe_way) const {
  TrajectoryOptimizer optimizer(
      space,
      {{config_.max_speed, config_.max_acceleration}, config_.clearance, config_.max_escape});
  double factor = 1.0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::optional<Bspline> curve = optimizer.optimize(guideAlong(way, start, factor));
    const double share = curve ? slowdown(*curve, start) : kSlower;
    if (curve && canBeFlown(share, start)) return slowed(*curve, share);
    factor = std::max(kSlowest, factor * std::clamp(share, kMuchSlower, kSlower));
  }
  return crawl(space, start, safe_way);
}

std::optional<Bspline> TrajectoryPlanner::crawl(const FlightSpace& space, const MotionState& start,
                                                const Polyline& safe_way) const {
  // With control points so near to each other, those that the curve lies between at any moment are
  // no farther apart than a voxel: it cannot leave the way's voxels and those that a step crosses.
  const double exact = space.resolution() / (Bspline::kDegree * config_.knot_interval);
  double factor = kSlowest;
  for (bool is_exact = false; !is_exact; factor *= kCrawlSlower) {
    is_exact = factor * kSpeedPart * config_.max_speed <= exact;
    const Bspline curve = guideAlong(safe_way, start, factor);
    const double share = slowdown(curve, start);
    const bool is_free = !firstCollision(Trajectory(curve, 0.0), space, {0.0}, config_.max_escape);
    if (is_free && canBeFlown(share, start)) return slowed(curve, share);
  }
  return std::nullopt;
}

double TrajectoryPlanner::slowdown(const Bspline& curve, const MotionState& start) const {
  const double max_speed = std::max(config_.max_speed, start.velocity.norm());
  const double max_acceleration = std::max(config_.max_acceleration, start.acceleration.norm());
  const double speed = std::max(kRounding, curve.speedBound());
  const double acceleration = std::max(kRounding, curve.accelerationBound());
  return (1.0 + kRounding) *
         std::min(max_speed / speed, std::sqrt(max_acceleration / acceleration));
}

}  // namespace fiimap
