#include "fiimap/structuring_element.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

using test::ElementDefinition;

constexpr ElementShape kShapes[] = {ElementShape::kBall, ElementShape::kCube,
                                    ElementShape::kDiamond};
// The squares of 1.73, 2.45 and 3.31 lie just below 3, 6 and 11, squared lengths of offsets.
constexpr int kRadiiMm[] = {0,   1,   50,  99,  100, 101, 141, 142, 150, 173, 174, 199,  200, 224,
                            245, 250, 299, 300, 301, 331, 332, 400, 500, 600, 700, 1000, 1050};

StructuringElement make(const ElementDefinition& d) {
  return {d.shape, d.radius(), d.resolution()};
}

class StructuringElementTest : public ::testing::TestWithParam<ElementDefinition> {};

TEST_P(StructuringElementTest, ContainsWhatTheDefinitionSays) {
  const ElementDefinition definition = GetParam();
  const StructuringElement element = make(definition);
  const VoxelIndex border = VoxelIndex::Constant(definition.ceilOfRadius() + 3);
  test::forEachVoxel({-border, border + VoxelIndex::Ones()}, [&](const VoxelIndex& d) {
    ASSERT_EQ(element.contains(d), definition.contains(d)) << test::describe(d);
  });
}

TEST_P(StructuringElementTest, ListsItsOffsetsInLexicographicOrder) {
  EXPECT_EQ(make(GetParam()).offsets(), GetParam().offsets());
}

TEST_P(StructuringElementTest, HalfHeightAgreesWithItsOffsets) {
  const ElementDefinition definition = GetParam();
  const StructuringElement element = make(definition);
  const int border = definition.ceilOfRadius() + 2;
  for (int dx = -border; dx <= border; ++dx) {
    for (int dy = -border; dy <= border; ++dy) {
      int largest = -1;
      for (int dz = 0; dz <= border; ++dz) {
        if (definition.contains({dx, dy, dz})) largest = dz;
      }
      ASSERT_EQ(element.halfHeight(dx, dy), largest) << dx << ", " << dy;
    }
  }
}

TEST_P(StructuringElementTest, ReachIsTheLargestCoordinate) {
  int largest = 0;
  for (const VoxelIndex& d : GetParam().offsets()) {
    largest = std::max(largest, d.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(make(GetParam()).reach(), largest);
}

std::vector<ElementDefinition> definitions() {
  std::vector<ElementDefinition> all;
  for (const ElementShape shape : kShapes) {
    for (const int radius_mm : kRadiiMm) all.push_back({shape, radius_mm, 100});
    for (const int radius_mm : {150, 250, 300, 375}) all.push_back({shape, radius_mm, 75});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Definitions, StructuringElementTest, ::testing::ValuesIn(definitions()),
                         [](const auto& info) {
                           return test::nameOf(info.param.shape) + "_" +
                                  std::to_string(info.param.radius_mm) + "_per_" +
                                  std::to_string(info.param.resolution_mm) + "mm";
                         });

TEST(StructuringElementSizeTest, IsTheKnownOneForSmallRadii) {
  EXPECT_EQ(StructuringElement(ElementShape::kBall, 0.1, 0.1).offsets().size(), 7u);
  EXPECT_EQ(StructuringElement(ElementShape::kBall, 0.2, 0.1).offsets().size(), 33u);
  EXPECT_EQ(StructuringElement(ElementShape::kDiamond, 0.2, 0.1).offsets().size(), 25u);
  EXPECT_EQ(StructuringElement(ElementShape::kCube, 0.1, 0.1).offsets().size(), 27u);
  EXPECT_EQ(StructuringElement(ElementShape::kCube, 0.11, 0.1).offsets().size(), 125u);
}

TEST(StructuringElementRadiusTest, ZeroIsTheVoxelItself) {
  for (const ElementShape shape : kShapes) {
    const StructuringElement element(shape, 0.0, 0.1);
    EXPECT_EQ(element.offsets(), std::vector<VoxelIndex>{VoxelIndex::Zero()});
    EXPECT_EQ(element.reach(), 0);
    EXPECT_EQ(element.halfHeight(0, 0), 0);
    EXPECT_EQ(element.halfHeight(1, 0), -1);
  }
}

TEST(StructuringElementRadiusTest, WholeVoxelsKeepTheOutermostVoxels) {
  for (const ElementShape shape : kShapes) {
    for (const double resolution : {0.01, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.7}) {
      for (int n = 1; n <= 20; ++n) {
        // The same radius reached by rounding from below, from above and by summing up.
        double sum = 0.0;
        for (int i = 0; i < n; ++i) sum += resolution;
        for (const double radius :
             {n * resolution, sum, std::stod(std::to_string(n * resolution))}) {
          const StructuringElement element(shape, radius, resolution);
          ASSERT_EQ(element.reach(), n) << radius << " / " << resolution;
          ASSERT_TRUE(element.contains({-n, 0, 0})) << radius << " / " << resolution;
          ASSERT_TRUE(element.contains({0, 0, n})) << radius << " / " << resolution;
          ASSERT_FALSE(element.contains({0, n + 1, 0})) << radius << " / " << resolution;
        }
      }
    }
  }
}

TEST(StructuringElementRadiusTest, RemembersWhatWasAskedFor) {
  const StructuringElement element(ElementShape::kCube, 0.123, 0.1);
  EXPECT_EQ(element.radius(), 0.123);
  EXPECT_EQ(element.shape(), ElementShape::kCube);
}

}  // namespace
}  // namespace fiimap
