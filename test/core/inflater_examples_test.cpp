#include "fiimap/inflater.h"

#include <string>

#include <gtest/gtest.h>

#include "inflation_fixture.h"
#include "oracle.h"

/// Named counter-examples: shortcuts of the published algorithm that lose or leave inflation, and
/// what a sliding window can do wrong. Expectations are written by hand.
namespace fiimap {
namespace {

using test::ElementDefinition;
using test::InflatedWorld;
using test::Method;

constexpr int kResolutionMm = 100;

ElementDefinition ball(int voxels) { return {ElementShape::kBall, voxels * kResolutionMm}; }

class InflaterExampleTest : public ::testing::TestWithParam<Method> {
 protected:
  InflaterExampleTest() : random_(1) {}

  InflatedWorld world(const ElementDefinition& element, const VoxelIndex& size) {
    return {GetParam(), element, size, &random_};
  }

  test::Random random_;
};

/// A world in which only one line of voxels is used: coordinate 0..size-1 along an axis.
class Line {
 public:
  Line(const Method& method, int length, int radius, int axis, test::Random* random)
      : axis_(axis), world_(method, ball(radius), sizeOf(length, axis), random) {
    world_.update(-world_.grid().window().min, {});
  }

  void flip(const std::vector<int>& positions) {
    test::VoxelSet flips;
    for (const int p : positions) flips.insert(voxel(p));
    world_.update(VoxelIndex::Zero(), flips);
  }

  /// '#' where inflated.
  std::string inflated() {
    std::string drawing;
    for (int p = 0; p < world_.grid().window().size()[axis_]; ++p) {
      drawing += world_.grid().test(Plane::kInflated, voxel(p)) ? '#' : '.';
    }
    return drawing;
  }

 private:
  static VoxelIndex sizeOf(int length, int axis) {
    VoxelIndex size(1, 1, 1);
    size[axis] = length;
    return size;
  }
  VoxelIndex voxel(int position) const {
    VoxelIndex v = VoxelIndex::Zero();
    v[axis_] = position;
    return v;
  }

  int axis_;
  InflatedWorld world_;
};

TEST_P(InflaterExampleTest, ClearingAroundARaisedVoxelKeepsWhatItsNeighbourInflates) {
  // Clearing out to 2L would erase x = 3, which belongs to the obstacle at 4.
  for (int axis = 0; axis < 3; ++axis) {
    Line line(GetParam(), 9, 1, axis, &random_);
    line.flip({1, 4});
    ASSERT_EQ(line.inflated(), "######...");
    line.flip({1});
    EXPECT_EQ(line.inflated(), "...###...") << "axis " << axis;
  }
}

TEST_P(InflaterExampleTest, ANewSourceGoesOnBehindInflatedVoxels) {
  // Stopping at voxels that are inflated already would lose x = 2, which only 4 inflates.
  for (int axis = 0; axis < 3; ++axis) {
    Line line(GetParam(), 9, 2, axis, &random_);
    line.flip({5});
    ASSERT_EQ(line.inflated(), "...#####.");
    line.flip({4});
    EXPECT_EQ(line.inflated(), "..######.") << "axis " << axis;
  }
}

TEST_P(InflaterExampleTest, ANewSourceGoesOnBehindOccupiedVoxels) {
  // 4 and 6 lie around the new source, yet only they, not it, reach the ends: nothing may be lost.
  Line line(GetParam(), 11, 3, 0, &random_);
  line.flip({4, 6});
  ASSERT_EQ(line.inflated(), ".#########.");
  line.flip({5});
  EXPECT_EQ(line.inflated(), ".#########.");
  line.flip({4, 6});
  EXPECT_EQ(line.inflated(), "..#######..");
}

TEST_P(InflaterExampleTest, ReinflatesFromSourcesUpToTwiceTheRadiusAway) {
  // x = 4 was inflated by both; its other source lies 2 L = 4 voxels from the raised one.
  for (int axis = 0; axis < 3; ++axis) {
    Line line(GetParam(), 10, 2, axis, &random_);
    line.flip({2, 6});
    ASSERT_EQ(line.inflated(), "#########.");
    line.flip({2});
    EXPECT_EQ(line.inflated(), "....#####.") << "axis " << axis;
  }
}

TEST_P(InflaterExampleTest, TwoRaisedSourcesAreReplacedByTheOnesBetweenAndBeside) {
  Line line(GetParam(), 13, 2, 1, &random_);
  line.flip({2, 4, 6, 10});
  ASSERT_EQ(line.inflated(), "#############");
  line.flip({2, 6});
  EXPECT_EQ(line.inflated(), "..#####.#####");
  line.flip({4});
  EXPECT_EQ(line.inflated(), "........#####");
}

TEST_P(InflaterExampleTest, TwoNewSourcesShareTheirTerritory) {
  // One visited mark for all sources would cut the second one short.
  for (const std::vector<int>& sources : {std::vector<int>{3, 4}, std::vector<int>{4, 3}}) {
    Line line(GetParam(), 9, 2, 2, &random_);
    line.flip(sources);
    EXPECT_EQ(line.inflated(), ".######..");
  }
}

TEST_P(InflaterExampleTest, OneScanRaisesAndLowersNeighbours) {
  Line line(GetParam(), 9, 2, 0, &random_);
  line.flip({3});
  line.flip({3, 4});
  EXPECT_EQ(line.inflated(), "..#####..");
}

TEST_P(InflaterExampleTest, ObstacleAtAFaceDoesNotInflateTheOppositeOne) {
  for (const VoxelIndex& size : {VoxelIndex(64, 64, 64), VoxelIndex(32, 33, 60),
                                 VoxelIndex(7, 9, 65), VoxelIndex(5, 5, 128)}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool at_max : {false, true}) {
        InflatedWorld world = this->world(ball(2), size);
        world.update({1000, -77, 13}, {});
        const VoxelBox window = world.grid().window();
        VoxelIndex obstacle = window.min + size / 2;
        obstacle[axis] = at_max ? window.max[axis] - 1 : window.min[axis];
        world.update(VoxelIndex::Zero(), {obstacle});
        EXPECT_EQ(world.grid().count(Plane::kInflated), 23) << "a ball of 33 without 10";
        world.grid().forEach(Plane::kInflated, window, [&](const VoxelIndex& v) {
          EXPECT_LE((v - obstacle).squaredNorm(), 4) << test::describe(v);
        });
      }
    }
  }
}

// Not for the searches, which take seconds at this radius.
TEST(IncrementalInflaterTest, AnElementLargerThanTheRingsGapDoesNotReachThroughIt) {
  // Rings of 128 columns and of 128 bits leave 31 between the window's end and its beginning.
  constexpr int kLength = 97, kRadius = 32;
  test::Random random(1);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int raised : {0, kLength - 1}) {
      Line line({InflationMethod::kIncremental, 6}, kLength, kRadius, axis, &random);
      line.flip({0, kLength - 1});
      line.flip({raised});
      const std::string inflated(kRadius + 1, '#'), free(kLength - kRadius - 1, '.');
      EXPECT_EQ(line.inflated(), raised == 0 ? free + inflated : inflated + free)
          << "axis " << axis;
    }
  }
}

TEST_P(InflaterExampleTest, ObstacleForgottenByASlideLosesItsInflation) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const VoxelIndex size(9, 10, 11);
      InflatedWorld world = this->world(ball(2), size);
      const VoxelBox window = world.grid().window();
      VoxelIndex obstacle = window.min + size / 2;
      obstacle[axis] = side < 0 ? window.min[axis] : window.max[axis] - 1;
      world.update(VoxelIndex::Zero(), {obstacle});
      ASSERT_EQ(world.grid().count(Plane::kInflated), 23);

      VoxelIndex step = VoxelIndex::Zero();
      step[axis] = -side;
      world.update(step, {});
      EXPECT_EQ(world.grid().count(Plane::kInflated), 0) << "axis " << axis << ", side " << side;
    }
  }
}

TEST_P(InflaterExampleTest, ASlideBringsBackTheInflationOfWhatWasCutOff) {
  // Part of the ball lay outside of the window: it must be there when the window moves that way.
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const VoxelIndex size(9, 10, 11);
      InflatedWorld world = this->world(ball(2), size);
      const VoxelBox window = world.grid().window();
      VoxelIndex obstacle = window.min + size / 2;
      obstacle[axis] = side < 0 ? window.min[axis] : window.max[axis] - 1;
      world.update(VoxelIndex::Zero(), {obstacle});

      VoxelIndex step = VoxelIndex::Zero();
      step[axis] = side;
      world.update(step, {});
      EXPECT_EQ(world.grid().count(Plane::kInflated), 32) << "axis " << axis << ", side " << side;
      world.update(step, {});
      EXPECT_EQ(world.grid().count(Plane::kInflated), 33) << "axis " << axis << ", side " << side;
      EXPECT_TRUE(world.inflationIsExact());
    }
  }
}

TEST_P(InflaterExampleTest, AnElementLargerThanTheWindowFillsIt) {
  InflatedWorld world = this->world({ElementShape::kCube, 1000, 100}, {5, 4, 3});
  world.update(VoxelIndex::Zero(), {world.grid().window().min});
  EXPECT_EQ(world.grid().count(Plane::kInflated), 60);
  world.update(VoxelIndex::Zero(), {world.grid().window().min});
  EXPECT_EQ(world.grid().count(Plane::kInflated), 0);
}

TEST_P(InflaterExampleTest, EveryVoxelOccupiedAndFreedAgain) {
  InflatedWorld world = this->world(ball(3), {12, 13, 14});
  test::VoxelSet all;
  test::forEachVoxel(world.grid().window(), [&](const VoxelIndex& v) { all.insert(v); });
  world.update(VoxelIndex::Zero(), all);
  EXPECT_EQ(world.grid().count(Plane::kInflated), 12 * 13 * 14);
  all.erase(world.grid().window().min);
  world.update(VoxelIndex::Zero(), all);
  EXPECT_TRUE(world.inflationIsExact());
  world.update(VoxelIndex::Zero(), {world.grid().window().min});
  EXPECT_EQ(world.grid().count(Plane::kInflated), 0);
}

INSTANTIATE_TEST_SUITE_P(All, InflaterExampleTest, ::testing::ValuesIn(test::kMethods),
                         test::nameOfMethod);

}  // namespace
}  // namespace fiimap
