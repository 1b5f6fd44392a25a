#include "fiimap/inflater.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "effort.h"
#include "inflation_fixture.h"
#include "oracle.h"

/// Invariant 1 for every method, shape and radius over random histories, against the definition.
namespace fiimap {
namespace {

using test::ElementDefinition;
using test::InflatedWorld;
using test::Method;

struct Case {
  Method method;
  ElementDefinition element;
};

constexpr ElementShape kShapes[] = {ElementShape::kBall, ElementShape::kCube,
                                    ElementShape::kDiamond};
/// L = 0..10 voxels of 100 mm, and radii that are not whole.
constexpr int kRadiiMm[] = {0,   100, 142, 200, 245, 299, 300, 400,
                            500, 600, 700, 800, 860, 900, 1000};

/// Neither powers of two nor wider than the element throughout, and the seams of words and tiles.
const VoxelIndex kWindows[] = {{1, 1, 1},   {9, 1, 1},  {1, 7, 3},    {7, 5, 20}, {13, 21, 9},
                               {33, 18, 4}, {8, 40, 2}, {5, 6, 63},   {6, 5, 64}, {4, 7, 66},
                               {64, 3, 5},  {3, 65, 6}, {19, 20, 17}, {3, 5, 140}};

/// How long a history is, how many voxels may flip at once, and one of how many windows is used.
struct Effort {
  int steps, flips, one_of;
};

/// The breadth-first search pays for each flip with the element's doubled volume.
Effort effortFor(const Case& c) {
  const bool is_large = c.element.ceilOfRadius() > 4;
  switch (c.method.method) {
    case InflationMethod::kIncremental:
      // Few obstacles and many that appear at once are not inflated alike.
      return is_large ? Effort{20, 100, 1} : Effort{60, 160, 1};
    case InflationMethod::kBfs:
      return is_large ? Effort{6, 4, 3} : Effort{12, 20, 1};
    case InflationMethod::kBatch:
      return is_large ? Effort{6, 20, 1} : Effort{12, 40, 1};
  }
  return {};
}

class InflaterTest : public ::testing::TestWithParam<Case> {};

TEST_P(InflaterTest, EqualsTheDefinitionAfterEveryStep) {
  const Effort effort = effortFor(GetParam());
  const int windows = static_cast<int>(std::size(kWindows));
  const int one_of = std::max(effort.one_of, windows / test::effort(windows));
  unsigned seed = 0;
  for (const VoxelIndex& window : kWindows) {
    // Other windows for other radii.
    if ((++seed + GetParam().element.ceilOfRadius()) % one_of != 0) continue;
    test::Random random(seed);
    InflatedWorld world(GetParam().method, GetParam().element, window, &random);
    for (int step = 0; step < effort.steps; ++step) {
      SCOPED_TRACE("window " + test::describe(window) + ", seed " + std::to_string(seed) +
                   ", step " + std::to_string(step));
      world.randomStep(effort.flips);
      ASSERT_TRUE(world.inflationIsExact());
    }
  }
}

std::vector<Case> allCases() {
  std::vector<Case> cases;
  for (const Method& method : test::kMethods) {
    for (const ElementShape shape : kShapes) {
      for (const int radius_mm : kRadiiMm) cases.push_back({method, {shape, radius_mm, 100}});
    }
  }
  return cases;
}

std::string nameOf(const ::testing::TestParamInfo<Case>& info) {
  return test::nameOf(info.param.method) + "_" + test::nameOf(info.param.element.shape) + "_" +
         std::to_string(info.param.element.radius_mm) + "mm";
}

INSTANTIATE_TEST_SUITE_P(All, InflaterTest, ::testing::ValuesIn(allCases()), nameOf);

/// Elements wider than a tile. Single obstacles that appear in the middle of the window are not
/// inflated as others are.
class WideElementTest : public ::testing::TestWithParam<ElementDefinition> {};

TEST_P(WideElementTest, EqualsTheDefinitionAroundObstaclesInTheMiddle) {
  constexpr int kSteps = 16, kMostFlips = 3, kFarthestSlide = 9;
  const int reach = GetParam().ceilOfRadius();
  const VoxelIndex to_middle(reach, reach, 0);
  for (const VoxelIndex& middle : {VoxelIndex(7, 11, 9), VoxelIndex(16, 3, 70)}) {
    test::Random random(reach);
    InflatedWorld world({InflationMethod::kIncremental, 6}, GetParam(), middle + 2 * to_middle,
                        &random);
    for (int step = 0; step < test::effort(kSteps); ++step) {
      SCOPED_TRACE("middle " + test::describe(middle) + ", step " + std::to_string(step));
      const int farthest = test::chance(random, 0.3) ? kFarthestSlide : 0;
      const VoxelIndex slide(test::uniformInt(random, -farthest, farthest),
                             test::uniformInt(random, -farthest, farthest),
                             test::uniformInt(random, -farthest, farthest));
      const VoxelIndex min = world.grid().window().min + slide + to_middle;
      test::VoxelSet flips;
      for (int i = test::uniformInt(random, 1, kMostFlips); i > 0; --i) {
        flips.insert(test::uniformVoxel(random, {min, min + middle}));
      }
      world.update(slide, flips);
      ASSERT_TRUE(world.inflationIsExact());
    }
  }
}

std::string nameOfElement(const ::testing::TestParamInfo<ElementDefinition>& info) {
  return test::nameOf(info.param.shape) + "_" + std::to_string(info.param.radius_mm) + "mm";
}

INSTANTIATE_TEST_SUITE_P(All, WideElementTest,
                         ::testing::Values(ElementDefinition{ElementShape::kBall, 1700},
                                           ElementDefinition{ElementShape::kCube, 1700},
                                           ElementDefinition{ElementShape::kDiamond, 3300},
                                           ElementDefinition{ElementShape::kCube, 3300}),
                         nameOfElement);

constexpr int kFlips = 20;

class InflationRadiusTest : public ::testing::TestWithParam<Method> {};

TEST_P(InflationRadiusTest, IsExactAfterEveryChangeOfElement) {
  for (int seed = 1; seed <= test::effort(3); ++seed) {
    test::Random random(seed);
    for (const VoxelIndex& window : {VoxelIndex(13, 21, 9), VoxelIndex(5, 34, 64)}) {
      InflatedWorld world(GetParam(), {ElementShape::kBall, 200, 100}, window, &random);
      for (int step = 0; step < 16; ++step) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
        const ElementDefinition element{kShapes[test::uniformInt(random, 0, 2)],
                                        kRadiiMm[test::uniformInt(random, 0, 9)], 100};
        world.changeElement(element);
        ASSERT_TRUE(world.inflationIsExact());
        world.randomStep(kFlips);
        ASSERT_TRUE(world.inflationIsExact());
      }
    }
  }
}

TEST_P(InflationRadiusTest, RebuildRepairsWhateverThePlaneHeld) {
  test::Random random(5);
  InflatedWorld world(GetParam(), {ElementShape::kBall, 200, 100}, {20, 20, 20}, &random);
  world.randomStep(kFlips);
  for (int i = 0; i < 200; ++i) {
    world.grid().set(Plane::kInflated, test::uniformVoxel(random, world.grid().window()),
                     test::chance(random, 0.5));
  }
  world.rebuild();
  EXPECT_TRUE(world.inflationIsExact());
}

INSTANTIATE_TEST_SUITE_P(All, InflationRadiusTest, ::testing::ValuesIn(test::kMethods),
                         test::nameOfMethod);

}  // namespace
}  // namespace fiimap
