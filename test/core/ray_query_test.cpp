// Rays through a snapshot: castRay and lineOfSight against their definition.

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/snapshot.h"
#include "line_oracle.h"
#include "oracle.h"

namespace fiimap {
namespace {

using test::GridSegment;
using Vector = Eigen::Vector3d;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr Unseen kChoices[] = {Unseen::kObstacle, Unseen::kFree};

std::vector<ObstacleRules> allRules() {
  std::vector<ObstacleRules> all;
  for (const MapLayer layer : {MapLayer::kInflated, MapLayer::kRaw}) {
    for (const Unseen unknown : kChoices) {
      for (const Unseen outside : kChoices) all.push_back({layer, unknown, outside});
    }
  }
  return all;
}

/// Whether a voxel is an obstacle, by the words of ObstacleRules.
bool blocks(const Snapshot& map, const VoxelIndex& v, const ObstacleRules& rules) {
  if (rules.layer == MapLayer::kRaw) {
    const Occupancy state = map.occupancy(v);
    return state == Occupancy::kOccupied ||
           (state == Occupancy::kUnknown && rules.unknown == Unseen::kObstacle) ||
           (state == Occupancy::kOutside && rules.outside == Unseen::kObstacle);
  }
  const Inflation state = map.inflation(v);
  return state == Inflation::kInflated ||
         (state == Inflation::kUnknown && rules.unknown == Unseen::kObstacle) ||
         (state == Inflation::kOutside && rules.outside == Unseen::kObstacle);
}

/// A window around `middle`, mostly free, with everything else in it here and there.
class RandomMap {
 public:
  RandomMap(test::Random* random, double resolution, const VoxelIndex& middle) : grid_({9, 8, 70}) {
    ChangeSet changes;
    grid_.moveTo(VoxelLattice::boxAround(middle, {9, 8, 70}).min, &changes);
    const double share = test::uniformReal(*random, 0.0, 0.1);
    test::forEachVoxel(grid_.window(), [&](const VoxelIndex& v) {
      grid_.set(Plane::kKnown, v, !test::chance(*random, share));
      const bool is_occupied = test::chance(*random, share);
      grid_.set(Plane::kOccupied, v, is_occupied);
      grid_.set(Plane::kInflated, v, is_occupied || test::chance(*random, share));
    });
    info_.resolution = resolution;
    if (test::chance(*random, 0.3)) {
      info_.walls = {resolution * (middle.z() - 5), resolution * (middle.z() + 4.4)};
    }
  }

  Snapshot snapshot() { return Snapshot(&grid_, info_); }

 private:
  SlidingGrid grid_;
  Snapshot::Info info_;
};

/// The obstacles that a segment passes, those that it enters first.
std::vector<test::PassedVoxel> firstObstacles(const Snapshot& map, const GridSegment& segment,
                                              const ObstacleRules& rules) {
  std::vector<test::PassedVoxel> first;
  for (const test::PassedVoxel& passed : segment.passed()) {
    if (!blocks(map, passed.v, rules)) continue;
    if (!first.empty() && passed.t_in < first.front().t_in) first.clear();
    if (first.empty() || passed.t_in == first.front().t_in) first.push_back(passed);
  }
  return first;
}

class RayQueryTest : public ::testing::TestWithParam<VoxelIndex> {};

TEST_P(RayQueryTest, StopsAtTheFirstObstacleOfTheDefinition) {
  constexpr double kResolution = 0.25, kRounding = 1e-9;  // voxels of a power of two are exact
  test::Random random(521);
  int hits = 0, free = 0;
  for (int round = 0; round < test::effort(150); ++round) {
    SCOPED_TRACE("seed 521, round " + std::to_string(round));
    RandomMap random_map(&random, kResolution, GetParam());
    const Snapshot map = random_map.snapshot();
    for (int i = 0; i < 20; ++i) {
      const VoxelIndex reach = VoxelIndex(6, 6, 9) * GridSegment::kParts;
      const VoxelBox box{GetParam() * GridSegment::kParts - reach,
                         GetParam() * GridSegment::kParts + reach};
      const GridSegment segment(test::uniformVoxel(random, box), test::uniformVoxel(random, box));
      const Vector from_W = kResolution * segment.from(), to_W = kResolution * segment.to();
      for (const ObstacleRules& rules : allRules()) {
        const auto expected = firstObstacles(map, segment, rules);
        const std::optional<RayHit> hit = map.castRay(from_W, to_W, rules);
        ASSERT_EQ(hit.has_value(), !expected.empty());
        ASSERT_EQ(map.lineOfSight(from_W, to_W, rules), expected.empty());
        ++(hit ? hits : free);
        if (!hit) continue;
        ASSERT_TRUE(std::any_of(expected.begin(), expected.end(), [&](const auto& passed) {
          return passed.v == hit->voxel;
        })) << test::describe(hit->voxel);
        const double t = expected.front().t_in.value();
        ASSERT_NEAR(hit->distance, t * (to_W - from_W).norm(), kRounding);
        ASSERT_NEAR((hit->point_W - (from_W + t * (to_W - from_W))).norm(), 0.0, kRounding);
      }
    }
  }
  EXPECT_GT(hits, test::effort(1000));
  EXPECT_GT(free, test::effort(1000));
}

TEST_P(RayQueryTest, OfAnySegmentNoPointThatIsSeenLiesInAnObstacle) {
  constexpr double kResolution = 0.1;
  test::Random random(522);
  int seen = 0;
  for (int round = 0; round < test::effort(300); ++round) {
    SCOPED_TRACE("seed 522, round " + std::to_string(round));
    RandomMap random_map(&random, kResolution, GetParam());
    const Snapshot map = random_map.snapshot();
    const auto randomPoint = [&] {
      return Vector(kResolution *
                    (GetParam().cast<double>() + Vector(test::uniformReal(random, -6, 6),
                                                        test::uniformReal(random, -6, 6),
                                                        test::uniformReal(random, -9, 9))));
    };
    const Vector a_W = randomPoint(), b_W = randomPoint();
    for (const ObstacleRules& rules : allRules()) {
      const bool sees = map.lineOfSight(a_W, b_W, rules);
      ASSERT_EQ(sees, map.lineOfSight(b_W, a_W, rules));
      const std::optional<RayHit> hit = map.castRay(a_W, b_W, rules);
      const double free_share = hit ? hit->distance / (b_W - a_W).norm() : 1.0;
      if (free_share == 0.0) continue;
      constexpr int kSamples = 100;
      for (int i = 0; i < kSamples; ++i) {
        const Vector p_W = a_W + free_share * i / kSamples * (b_W - a_W);
        ASSERT_FALSE(blocks(map, map.lattice().indexOf(p_W), rules)) << p_W.transpose();
      }
      seen += sees;
    }
  }
  EXPECT_GT(seen, test::effort(100));
}

INSTANTIATE_TEST_SUITE_P(Places, RayQueryTest,
                         ::testing::Values(VoxelIndex(0, 0, 0), VoxelIndex(-3, 40, 1000),
                                           VoxelIndex(200000, -300000, -65)));

TEST(RayQueryExampleTest, NoPlaceIsBetweenTwoObstaclesThatTouchInAnEdge) {
  SlidingGrid grid({8, 8, 8});
  test::forEachVoxel(grid.window(), [&](const VoxelIndex& v) { grid.set(Plane::kKnown, v, true); });
  grid.set(Plane::kOccupied, {0, 1, 0}, true);
  grid.set(Plane::kOccupied, {1, 0, 0}, true);
  Snapshot::Info info;
  info.resolution = 1.0;
  const Snapshot map(&grid, info);
  const ObstacleRules rules{MapLayer::kRaw, Unseen::kFree, Unseen::kFree};
  EXPECT_FALSE(map.lineOfSight({0.5, 0.5, 0.5}, {1.5, 1.5, 0.5}, rules));
  EXPECT_EQ(map.castRay({0.5, 0.5, 0.5}, {1.5, 1.5, 0.5}, rules)->point_W, Vector(1, 1, 0.5));
  EXPECT_TRUE(map.lineOfSight({0.5, 0.5, 0.5}, {0.9, 0.9, 0.5}, rules));
}

TEST(RayQueryExampleTest, ARayThatStartsInAnObstacleHasNoLength) {
  SlidingGrid grid({8, 8, 8});
  grid.set(Plane::kOccupied, {0, 0, 0}, true);
  Snapshot::Info info;
  info.resolution = 1.0;
  const Snapshot map(&grid, info);
  const auto hit =
      map.castRay({0.5, 0.5, 0.5}, {3, 3, 3}, {MapLayer::kRaw, Unseen::kFree, Unseen::kFree});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->voxel, VoxelIndex(0, 0, 0));
  EXPECT_EQ(hit->point_W, Vector(0.5, 0.5, 0.5));
  EXPECT_EQ(hit->distance, 0.0);
}

TEST(RayQueryExampleTest, ASegmentWithoutVoxelsIsBlockedAtItsStart) {
  SlidingGrid grid({8, 8, 8});
  Snapshot::Info info;
  info.resolution = 0.1;
  const Snapshot map(&grid, info);
  const Vector zero = Vector::Zero();
  for (const double bad : {kNoNumber, kEndless, -kEndless, 1e300, 1e9}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector end = zero;
      end[axis] = bad;
      for (const ObstacleRules& rules : allRules()) {
        EXPECT_FALSE(map.lineOfSight(zero, end, rules)) << bad;
        EXPECT_FALSE(map.lineOfSight(end, zero, rules)) << bad;
        const auto hit = map.castRay(zero, end, rules);
        ASSERT_TRUE(hit) << bad;
        EXPECT_EQ(hit->distance, 0.0);
        EXPECT_FALSE(map.window().contains(hit->voxel));
      }
    }
  }
}

}  // namespace
}  // namespace fiimap
