#include "path_search.h"

#include <algorithm>
#include <map>
#include <optional>
#include <queue>

#include "planner_map.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.1;
constexpr std::size_t kEnough = 100000;
constexpr double kMaxEscape = 10.0;

/// A step may be taken when all voxels of the box that it crosses may be entered; one of them is
/// where it starts.
template <typename IsOpen>
bool isStepOpen(const VoxelIndex& from, const VoxelIndex& to, IsOpen&& is_open) {
  bool open = true;
  const VoxelIndex low = from.cwiseMin(to), high = from.cwiseMax(to);
  test::forEachVoxel({low, high + VoxelIndex::Ones()},
                     [&](const VoxelIndex& v) { open = open && (v == from || is_open(v)); });
  return open;
}

std::int64_t stepCost(const VoxelIndex& offset) {
  return std::lround(kPathUnit * std::sqrt(offset.cwiseAbs().sum()));
}

/// Dijkstra's algorithm, written from its definition: lengths of the shortest paths to all voxels.
template <typename IsOpen>
std::map<VoxelIndex, std::int64_t, test::VoxelLess> distances(const VoxelIndex& start,
                                                              const VoxelBox& region,
                                                              IsOpen&& is_open) {
  std::map<VoxelIndex, std::int64_t, test::VoxelLess> all;
  using Entry = std::pair<std::int64_t, std::array<int, 3>>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  queue.push({0, {start.x(), start.y(), start.z()}});
  while (!queue.empty()) {
    const auto [cost, at] = queue.top();
    queue.pop();
    const VoxelIndex v(at[0], at[1], at[2]);
    if (!all.emplace(v, cost).second) continue;
    test::forEachVoxel({v.array() - 1, v.array() + 2}, [&](const VoxelIndex& next) {
      if (next == v || !region.contains(next) || all.count(next) > 0) return;
      if (!isStepOpen(v, next,
                      [&](const VoxelIndex& u) { return region.contains(u) && is_open(u); }))
        return;
      queue.push({cost + stepCost(next - v), {next.x(), next.y(), next.z()}});
    });
  }
  return all;
}

std::int64_t lengthOf(const std::vector<VoxelIndex>& voxels, std::size_t first) {
  std::int64_t length = 0;
  for (std::size_t i = first + 1; i < voxels.size(); ++i)
    length += stepCost(voxels[i] - voxels[i - 1]);
  return length;
}

/// Every step of the path is to a neighbour and open.
void expectValid(const VoxelPath& path, const FlightSpace& space, const VoxelIndex& start) {
  ASSERT_FALSE(path.voxels.empty());
  EXPECT_EQ(path.voxels.front(), start);
  for (std::size_t i = 0; i < path.voxels.size(); ++i) {
    EXPECT_EQ(space.isFree(path.voxels[i]), i >= path.escape) << test::describe(path.voxels[i]);
    if (i == 0) continue;
    ASSERT_EQ((path.voxels[i] - path.voxels[i - 1]).cwiseAbs().maxCoeff(), 1);
    const bool open = isStepOpen(path.voxels[i - 1], path.voxels[i], [&](const VoxelIndex& v) {
      return i <= path.escape ? space.isCrossable(v) : space.isFree(v);
    });
    EXPECT_TRUE(open) << test::describe(path.voxels[i]);
  }
  EXPECT_EQ(path.cost, lengthOf(path.voxels, path.escape));
}

std::optional<VoxelIndex> randomVoxel(test::Random& random, const FlightSpace& space, bool free) {
  constexpr int kTries = 200;
  for (int i = 0; i < kTries; ++i) {
    const VoxelIndex v = test::uniformVoxel(random, space.snapshot().window());
    const bool fits = free ? space.isFree(v) : !space.isFree(v) && space.isCrossable(v);
    if (fits) return v;
  }
  return std::nullopt;
}

TEST(PathSearchTest, IsAsShortAsDijkstra) {
  test::Random random(501);
  PathSearch search(kEnough);
  int reached = 0, unreachable = 0;
  for (int round = 0; round < 120; ++round) {
    SCOPED_TRACE("seed 501, round " + std::to_string(round));
    test::PlannerMap map({14, 12, 8}, kResolution, round % 2 == 0 ? 0.0 : 0.1);
    for (int i = 0; i < 30 * (round % 10); ++i)
      map.occupy(test::uniformVoxel(random, map.window()));
    const FlightSpace space = map.space();
    const auto start = randomVoxel(random, space, true), goal = randomVoxel(random, space, true);
    if (!start || !goal) continue;
    const auto expected =
        distances(*start, map.window(), [&](const VoxelIndex& v) { return space.isFree(v); });

    const VoxelPath path = search.find(space, *start, *goal, map.window(), kMaxEscape);
    expectValid(path, space, *start);
    const auto found = expected.find(*goal);
    EXPECT_EQ(path.end == PathEnd::kGoal, found != expected.end());
    if (found != expected.end()) {
      EXPECT_EQ(path.voxels.back(), *goal);
      EXPECT_EQ(path.cost, found->second);
      ++reached;
    } else {
      // The reached voxel is the nearest of those that can be reached, in steps of a free grid.
      EXPECT_EQ(path.end, PathEnd::kNearest);
      EXPECT_EQ(path.visited, expected.size());
      EXPECT_EQ(expected.count(path.voxels.back()), 1u);
      ++unreachable;
    }
  }
  EXPECT_GT(reached, 50);
  EXPECT_GT(unreachable, 5);
}

TEST(PathSearchTest, EndsAtTheBorderOnTheShortestWayToAGoalOutside) {
  test::Random random(502);
  PathSearch search(kEnough);
  int reached = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("seed 502, round " + std::to_string(round));
    test::PlannerMap map({12, 12, 6}, kResolution, 0.0);
    for (int i = 0; i < 150; ++i) map.occupy(test::uniformVoxel(random, map.window()));
    const FlightSpace space = map.space();
    const auto start = randomVoxel(random, space, true);
    ASSERT_TRUE(start);
    const VoxelIndex goal(map.window().max.x() + test::uniformInt(random, 0, 10),
                          test::uniformInt(random, -5, 5), test::uniformInt(random, -2, 2));
    const VoxelPath path = search.find(space, *start, goal, map.window(), kMaxEscape);
    expectValid(path, space, *start);
    const auto all =
        distances(*start, map.window(), [&](const VoxelIndex& v) { return space.isFree(v); });
    // Best over the voxels of the face: way there and shortest way on through free space.
    std::optional<std::int64_t> best;
    for (const auto& [v, cost] : all) {
      if (v.x() + 1 != map.window().max.x()) continue;
      VoxelIndex d = (goal - v).cwiseAbs();
      std::sort(d.data(), d.data() + 3);
      const std::int64_t on = d[0] * stepCost({1, 1, 1}) + (d[1] - d[0]) * stepCost({1, 1, 0}) +
                              (d[2] - d[1]) * stepCost({1, 0, 0});
      if (!best || cost + on < *best) best = cost + on;
    }
    EXPECT_EQ(path.end == PathEnd::kBorder, best.has_value());
    if (!best) continue;
    ++reached;
    VoxelIndex d = (goal - path.voxels.back()).cwiseAbs();
    std::sort(d.data(), d.data() + 3);
    EXPECT_EQ(path.cost + d[0] * stepCost({1, 1, 1}) + (d[1] - d[0]) * stepCost({1, 1, 0}) +
                  (d[2] - d[1]) * stepCost({1, 0, 0}),
              *best);
  }
  EXPECT_GT(reached, 40);
}

TEST(PathSearchTest, LeavesInflatedSpaceByTheShortestWayThroughNoOccupiedVoxel) {
  test::Random random(503);
  PathSearch search(kEnough);
  int escaped = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("seed 503, round " + std::to_string(round));
    test::PlannerMap map({16, 16, 8}, kResolution, 0.2);
    for (int i = 0; i < 40; ++i) map.occupy(test::uniformVoxel(random, map.window()));
    const FlightSpace space = map.space();
    const auto start = randomVoxel(random, space, false);
    if (!start) continue;
    const VoxelPath path =
        search.find(space, *start, VoxelIndex(0, 0, 0), map.window(), kMaxEscape);
    const auto all = distances(*start, map.window(), [&](const VoxelIndex& v) {
      return (v - *start).cast<double>().norm() <= kMaxEscape && space.isCrossable(v);
    });
    std::optional<std::int64_t> nearest;
    for (const auto& [v, cost] : all) {
      if (space.isFree(v) && (!nearest || cost < *nearest)) nearest = cost;
    }
    EXPECT_EQ(path.end == PathEnd::kNowhere, !nearest.has_value());
    if (!nearest) continue;
    expectValid(path, space, *start);
    ASSERT_GT(path.escape, 0u);
    const std::vector<VoxelIndex> way_out(path.voxels.begin(),
                                          path.voxels.begin() + path.escape + 1);
    EXPECT_EQ(lengthOf(way_out, 0), *nearest);
    ++escaped;
  }
  EXPECT_GT(escaped, 30);
}

TEST(PathSearchTest, ARoughWayIsAsShortAsDijkstraOverTheMiddlesOfCubes) {
  test::Random random(504);
  PathSearch search(kEnough);
  constexpr int kStride = 3;
  const auto middleOf = [=](const VoxelIndex& cube) -> VoxelIndex {
    return (cube * kStride).array() + 1;
  };
  // Whole cubes of the window [-21, 21) x [-21, 21) x [-9, 9).
  const VoxelBox cubes{{-7, -7, -3}, {7, 7, 3}};
  int reached = 0, unreachable = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("seed 504, round " + std::to_string(round));
    test::PlannerMap map({42, 42, 18}, kResolution, 0.2);
    for (int i = 0; i < 60 * (round % 6); ++i) map.occupy(test::uniformVoxel(random, map.window()));
    const FlightSpace space = map.space();
    const VoxelIndex first = test::uniformVoxel(random, cubes);
    const VoxelIndex last = test::uniformVoxel(random, cubes);
    const VoxelIndex goal = middleOf(last) + VoxelIndex(1, -1, 0);
    const auto all = distances(first, cubes, [&](const VoxelIndex& cube) {
      return space.isFree(cube == last ? goal : middleOf(cube));
    });
    const VoxelPath path = search.findRoughly(space, middleOf(first), goal, map.window(), kStride);
    ASSERT_FALSE(path.voxels.empty());
    EXPECT_EQ(path.voxels.front(), middleOf(first));
    for (std::size_t i = 1; i < path.voxels.size(); ++i) {
      EXPECT_EQ((path.voxels[i] - path.voxels[i - 1]).cwiseAbs().maxCoeff(), kStride);
    }
    const auto found = all.find(last);
    EXPECT_EQ(path.end == PathEnd::kGoal, found != all.end());
    if (found == all.end()) {
      ++unreachable;
      continue;
    }
    EXPECT_EQ(path.voxels.back(), middleOf(last));
    EXPECT_EQ(path.cost, kStride * found->second);
    ++reached;
  }
  EXPECT_GT(reached, 30);
  EXPECT_GT(unreachable, 3);
}

TEST(PathSearchTest, DoesNotCutCorners) {
  test::PlannerMap map({5, 5, 1}, kResolution, 0.0);
  map.occupy(VoxelIndex(0, 1, 0));
  map.occupy(VoxelIndex(1, 0, 0));
  PathSearch search(kEnough);
  const VoxelPath path = search.find(map.space(), {0, 0, 0}, {1, 1, 0}, map.window(), kMaxEscape);
  EXPECT_EQ(path.end, PathEnd::kGoal);
  EXPECT_GT(path.voxels.size(), 3u);
}

TEST(PathSearchTest, StopsAfterSoMuchWork) {
  test::PlannerMap map({40, 40, 20}, kResolution, 0.0);
  map.occupy(VoxelBox{{10, -20, -10}, {11, 20, 10}});
  constexpr std::size_t kLittle = 500;
  PathSearch search(kLittle);
  const VoxelPath path = search.find(map.space(), {0, 0, 0}, {15, 0, 0}, map.window(), kMaxEscape);
  EXPECT_EQ(path.end, PathEnd::kNearest);
  EXPECT_EQ(path.visited, kLittle);
  EXPECT_EQ(path.voxels.back(), VoxelIndex(9, 0, 0));
}

TEST(PathSearchTest, GivesUpInsideOfAnObstacle) {
  test::PlannerMap map({20, 20, 20}, kResolution, 0.0);
  map.occupy(map.window());
  PathSearch search(kEnough);
  const VoxelPath path = search.find(map.space(), {0, 0, 0}, {5, 0, 0}, map.window(), kMaxEscape);
  EXPECT_EQ(path.end, PathEnd::kNowhere);
  EXPECT_TRUE(path.voxels.empty());
}

TEST(PathSearchTest, AGoalAtTheEndOfTheWorldIsNoTrouble) {
  test::PlannerMap map({20, 20, 20}, kResolution, 0.0);
  PathSearch search(kEnough);
  const VoxelPath path =
      search.find(map.space(), {0, 0, 0}, {2000000000, -2000000000, 0}, map.window(), kMaxEscape);
  EXPECT_EQ(path.end, PathEnd::kBorder);
}

}  // namespace
}  // namespace fiimap
