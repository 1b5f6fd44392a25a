#include "fiimap/snapshot.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "effort.h"
#include "inflation_fixture.h"
#include "oracle.h"

/// Differences between snapshots against their definition.
namespace fiimap {
namespace {

using test::VoxelSet;

constexpr Plane kPlanes[] = {Plane::kKnown, Plane::kOccupied, Plane::kInflated};

VoxelSet voxelsOf(const Snapshot* snapshot, Plane plane) {
  if (snapshot == nullptr) return {};
  const std::vector<VoxelIndex> voxels = snapshot->voxels(plane, snapshot->window());
  return VoxelSet(voxels.begin(), voxels.end());
}

/// In the window of `after` and set in one of both only.
VoxelSet difference(Plane plane, const Snapshot* before, const Snapshot& after) {
  const VoxelSet then = voxelsOf(before, plane), now = voxelsOf(&after, plane);
  VoxelSet all, inside;
  std::set_symmetric_difference(then.begin(), then.end(), now.begin(), now.end(),
                                std::inserter(all, all.end()), test::VoxelLess());
  for (const VoxelIndex& v : all) {
    if (after.window().contains(v)) inside.insert(v);
  }
  return inside;
}

/// Holds the runs to the definition: their voxels, their order, and that none touches the next.
void expectChanges(Plane plane, const Snapshot* before, const Snapshot& after) {
  VoxelSet found;
  const std::vector<VoxelRun> runs = after.changes(plane, before);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ASSERT_GE(runs[i].count, 1);
    VoxelIndex v = runs[i].first;
    for (int n = 0; n < runs[i].count; ++n, ++v.z()) found.insert(v);
    if (i + 1 == runs.size()) break;
    ASSERT_TRUE(test::VoxelLess()(v, runs[i + 1].first)) << "after " << test::describe(v);
  }
  ASSERT_EQ(found, difference(plane, before, after));
}

Snapshot snapshotOf(test::InflatedWorld* world) {
  Snapshot::Info info;
  info.resolution = 0.1;
  return Snapshot(&world->grid(), info);
}

const VoxelIndex kWindows[] = {{1, 1, 1},  {1, 70, 3},  {33, 31, 4}, {7, 5, 63},
                               {5, 6, 64}, {4, 40, 66}, {65, 3, 5},  {3, 5, 140}};

class SnapshotChangesTest : public ::testing::TestWithParam<int> {};

TEST_P(SnapshotChangesTest, AreWhatDiffersInTheWindow) {
  constexpr int kSteps = 30, kFlips = 60;
  for (const VoxelIndex& window : kWindows) {
    test::Random random(GetParam());
    test::InflatedWorld world(test::kMethods[0], {ElementShape::kBall, 200, 100}, window, &random);
    std::vector<Snapshot> history;
    for (int step = 0; step < kSteps; ++step) {
      SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", window " + test::describe(window) +
                   ", step " + std::to_string(step));
      for (int several = test::uniformInt(random, 0, 2); several >= 0; --several) {
        world.randomStep(kFlips);
      }
      history.push_back(snapshotOf(&world));
      const Snapshot& now = history.back();
      const Snapshot& earlier = history[test::uniformInt(random, 0, step)];
      for (const Plane plane : kPlanes) {
        expectChanges(plane, nullptr, now);
        expectChanges(plane, &earlier, now);
        expectChanges(plane, &now, earlier);
        if (step > 0) expectChanges(plane, &history[step - 1], now);
        ASSERT_FALSE(HasFatalFailure());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SnapshotChangesTest, ::testing::Range(1, 1 + test::effort(10)));

}  // namespace
}  // namespace fiimap
