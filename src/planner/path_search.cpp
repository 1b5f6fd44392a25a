#include "path_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fiimap {
namespace {

constexpr int kNeighbours = 27;  // of a 3 x 3 x 3 box, with the voxel itself in the middle
constexpr int kSelf = 13;
// One voxel may enter the table from each of its visited neighbours, but few do.
constexpr std::size_t kNodesPerVisit = 4;
constexpr double kMaxGoalDistance = 1e8;  // voxels; costs stay far from the limits of their type

/// A step to a neighbour, as the place in the box around a voxel, and what it needs.
struct Step {
  VoxelIndex offset;
  std::int64_t cost;
  std::uint32_t needed;  ///< bits of the neighbours that must be open: the box that it crosses
};

constexpr std::uint32_t bitOf(int neighbour) { return std::uint32_t{1} << neighbour; }

VoxelIndex offsetOf(int neighbour) {
  return {neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1};
}

std::array<Step, kNeighbours> makeSteps() {
  constexpr std::int64_t kCosts[] = {0, kPathUnit, 14142, 17321};  // by the number of axes
  std::array<Step, kNeighbours> steps;
  for (int i = 0; i < kNeighbours; ++i) {
    const VoxelIndex offset = offsetOf(i);
    steps[i] = {offset, kCosts[offset.cwiseAbs().sum()], 0};
    for (int other = 0; other < kNeighbours; ++other) {
      const VoxelIndex o = offsetOf(other);
      const bool is_crossed = (o.array() == 0 || o.array() == offset.array()).all();
      if (is_crossed && other != kSelf) steps[i].needed |= bitOf(other);
    }
  }
  return steps;
}

const std::array<Step, kNeighbours>& steps() {
  static const std::array<Step, kNeighbours> all = makeSteps();
  return all;
}

/// Length of the shortest path when everything is free.
std::int64_t freeCost(const VoxelIndex& offset) {
  VoxelIndex d = offset.cwiseAbs();
  if (d.x() < d.y()) std::swap(d.x(), d.y());
  if (d.y() < d.z()) std::swap(d.y(), d.z());
  if (d.x() < d.y()) std::swap(d.x(), d.y());
  constexpr std::int64_t kSecond = 14142 - kPathUnit, kThird = 17321 - 14142;
  return std::int64_t{kPathUnit} * d.x() + kSecond * d.y() + kThird * d.z();
}

/// The goal, or a point on the way to it that is not absurdly far away.
VoxelIndex boundedGoal(const VoxelIndex& start, const VoxelIndex& goal) {
  const Eigen::Vector3d offset = goal.cast<double>() - start.cast<double>();
  const double scale = std::min(1.0, kMaxGoalDistance / (1.0 + offset.cwiseAbs().maxCoeff()));
  return start + (scale * offset).array().round().matrix().cast<int>();
}

/// The cube of `stride` voxels along each axis that holds a voxel, in a grid of such cubes.
VoxelIndex cubeOf(const VoxelIndex& v, int stride) {
  return (v.cast<double>() / stride).array().floor().matrix().cast<int>();
}

/// Whether one step from a voxel of the region towards a goal outside of it leaves the region.
bool isOnBorderTo(const VoxelIndex& goal, const VoxelIndex& v, const VoxelBox& region) {
  return ((goal.array() >= region.max.array() && v.array() + 1 == region.max.array()) ||
          (goal.array() < region.min.array() && v.array() == region.min.array()))
      .any();
}

}  // namespace

PathSearch::PathSearch(std::size_t max_visited)
    : max_visited_(max_visited), nodes_(kNodesPerVisit * max_visited) {}

VoxelPath PathSearch::find(const FlightSpace& space, const VoxelIndex& start,
                           const VoxelIndex& goal, const VoxelBox& region, double max_escape) {
  region_ = region;
  VoxelPath path;
  VoxelIndex first_free = start;
  if (!space.isFree(start)) {
    if (!escape(space, start, max_escape, &path)) return path;
    first_free = end_;
  }
  searchFor(
      first_free, boundedGoal(start, goal), [&](const VoxelIndex& v) { return space.isFree(v); },
      &path);
  return path;
}

VoxelPath PathSearch::findRoughly(const FlightSpace& space, const VoxelIndex& start,
                                  const VoxelIndex& goal, const VoxelBox& region, int stride) {
  const auto middleOf = [stride](const VoxelIndex& cube) -> VoxelIndex {
    return (cube * stride).array() + stride / 2;
  };
  const VoxelIndex first = cubeOf(start, stride);
  const VoxelIndex target = cubeOf(boundedGoal(start, goal), stride);
  // Cubes that lie in the region as a whole.
  region_ = {cubeOf(region.min.array() + stride - 1, stride), cubeOf(region.max, stride)};
  VoxelPath path;
  if (!region_.contains(first)) return path;
  searchFor(
      first, target,
      [&](const VoxelIndex& cube) { return space.isFree(cube == target ? goal : middleOf(cube)); },
      &path);
  for (VoxelIndex& v : path.voxels) v = middleOf(v);
  path.voxels.front() = start;
  path.cost *= stride;
  return path;
}

template <typename IsOpen>
void PathSearch::searchFor(const VoxelIndex& start, const VoxelIndex& target, IsOpen&& is_open,
                           VoxelPath* path) {
  const bool ends_at_goal = region_.contains(target);
  const bool reached = run(
      start, is_open, [&](const VoxelIndex& v) { return freeCost(target - v); },
      [&](const VoxelIndex& v) {
        return ends_at_goal ? v == target : isOnBorderTo(target, v, region_);
      });
  const VoxelIndex last = reached ? end_ : nearest_;
  path->end = !reached ? PathEnd::kNearest : ends_at_goal ? PathEnd::kGoal : PathEnd::kBorder;
  path->cost = costOf(last);
  path->visited += visited_;
  trace(last, &path->voxels);
  path->voxels.push_back(last);
}

bool PathSearch::escape(const FlightSpace& space, const VoxelIndex& start, double max_escape,
                        VoxelPath* path) {
  const double max_squared = max_escape * max_escape;
  const bool found = run(
      start,
      [&](const VoxelIndex& v) {
        return (v - start).cast<double>().squaredNorm() <= max_squared && space.isCrossable(v);
      },
      [](const VoxelIndex&) { return std::int64_t{0}; },
      [&](const VoxelIndex& v) { return space.isFree(v); });
  path->visited = visited_;
  if (!found) return false;
  trace(end_, &path->voxels);
  path->escape = path->voxels.size();
  return true;
}

template <typename IsOpen, typename Heuristic, typename IsEnd>
bool PathSearch::run(const VoxelIndex& start, IsOpen&& is_open, Heuristic&& heuristic,
                     IsEnd&& is_end) {
  nodes_.clear();
  visited_ = 0;
  std::int64_t nearest_distance = std::numeric_limits<std::int64_t>::max();
  bool is_new = false;
  SearchNodes::Node* const first = nodes_.get(start - region_.min, &is_new);
  first->step = kSelf;
  nodes_.push(*first, heuristic(start));
  while (!nodes_.empty() && visited_ < max_visited_) {
    const SearchNodes::Entry entry = nodes_.pop();
    SearchNodes::Node& node = nodes_.at(entry.slot);
    if (node.done) continue;  // pushed again later, with a shorter way
    node.done = true;
    ++visited_;
    const VoxelIndex v = region_.min + SearchNodes::voxelOf(node);
    if (entry.heuristic < nearest_distance) {
      nearest_distance = entry.heuristic;
      nearest_ = v;
    }
    if (is_end(v)) {
      end_ = v;
      return true;
    }
    expand(node, is_open, heuristic);
  }
  return false;
}

template <typename IsOpen, typename Heuristic>
void PathSearch::expand(const SearchNodes::Node& node, IsOpen&& is_open, Heuristic&& heuristic) {
  const VoxelIndex v = region_.min + SearchNodes::voxelOf(node);
  const std::int64_t cost = node.cost;
  std::uint32_t open = 0;
  for (int i = 0; i < kNeighbours; ++i) {
    const VoxelIndex neighbour = v + steps()[i].offset;
    if (i != kSelf && region_.contains(neighbour) && is_open(neighbour)) open |= bitOf(i);
  }
  for (int i = 0; i < kNeighbours; ++i) {
    const Step& step = steps()[i];
    if (i == kSelf || (open & step.needed) != step.needed) continue;
    const VoxelIndex neighbour = v + step.offset;
    bool is_new = false;
    SearchNodes::Node* const next = nodes_.get(neighbour - region_.min, &is_new);
    if (next == nullptr)
      return;  // as much as the memory holds; the search goes on with what it has
    if (!is_new && next->cost <= cost + step.cost) continue;
    next->cost = cost + step.cost;
    next->step = static_cast<std::int8_t>(i);
    nodes_.push(*next, heuristic(neighbour));
  }
}

void PathSearch::trace(const VoxelIndex& end, std::vector<VoxelIndex>* voxels) const {
  const std::size_t begin = voxels->size();
  VoxelIndex v = end;
  for (int step = nodes_.find(v - region_.min)->step; step != kSelf;) {
    v -= steps()[step].offset;
    voxels->push_back(v);
    step = nodes_.find(v - region_.min)->step;
  }
  std::reverse(voxels->begin() + static_cast<std::ptrdiff_t>(begin), voxels->end());
}

}  // namespace fiimap
