#include "fiimap/point_projector.h"

#include <cmath>

#include <gtest/gtest.h>

#include "oracle.h"
#include "special_numbers.h"

namespace fiimap {
namespace {

constexpr double kPointTolerance = 1e-5;  // m

MapperConfig limits(double min, double max, ReadingPolicy beyond = ReadingPolicy::kFree) {
  MapperConfig config;
  config.min_ray_length = min;
  config.max_ray_length = max;
  config.beyond_max_depth = beyond;
  return config;
}

struct Projected {
  ReadingCount count;
  RangeData scan;
};

Projected project(const MapperConfig& config, const std::vector<Eigen::Vector3f>& points,
                  const Eigen::Isometry3d& T_W_S = Eigen::Isometry3d::Identity()) {
  Projected result;
  result.scan.returns.resize(2);  // must be filled anew
  result.scan.misses.resize(2);
  result.count = PointProjector(config).project({points}, T_W_S, &result.scan);
  return result;
}

TEST(PointProjectorTest, ReturnsAreOffsetsFromTheSensorInWorldAxes) {
  test::Random random(71);
  for (int round = 0; round < 100; ++round) {
    Eigen::Isometry3d T_W_S = Eigen::Isometry3d::Identity();
    T_W_S.linear() =
        Eigen::AngleAxisd(
            test::uniformReal(random, -3.0, 3.0),
            Eigen::Vector3d(0.3, test::uniformReal(random, -1.0, 1.0), 1.0).normalized())
            .toRotationMatrix();
    T_W_S.translation() << 12345.678, test::uniformReal(random, -1e5, 1e5), -3.0;
    const Eigen::Vector3f point_S = Eigen::Vector3f::NullaryExpr(
        [&](Eigen::Index) { return static_cast<float>(test::uniformReal(random, 1.0, 20.0)); });
    const Projected result = project(limits(0.5, 100.0), {point_S}, T_W_S);
    EXPECT_EQ(result.scan.origin, T_W_S.translation());
    ASSERT_EQ(result.scan.returns.size(), 1u);
    const Eigen::Vector3d expected = T_W_S * point_S.cast<double>() - T_W_S.translation();
    EXPECT_LT((result.scan.returns[0].cast<double>() - expected).norm(), kPointTolerance)
        << "seed 71";
  }
}

TEST(PointProjectorTest, PointsThatAreNotFiniteAreCountedAndLeftOut) {
  std::vector<Eigen::Vector3f> points = {{1.0f, 2.0f, 3.0f}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float bad : {kNan, kInf, -kInf}) {
      points.emplace_back(1.0f, 1.0f, 1.0f);
      points.back()[axis] = bad;
    }
  }
  points.emplace_back(kInf, -kInf, kNan);
  const Projected result = project(limits(0.1, 10.0), points);
  EXPECT_EQ(result.count.total, 11u);
  EXPECT_EQ(result.count.invalid, 10u);
  EXPECT_EQ(result.count.returns, 1u);
  EXPECT_EQ(result.scan.returns.size(), 1u);
  EXPECT_TRUE(result.scan.misses.empty());
}

TEST(PointProjectorTest, TooNearPointsAreLeftOut) {
  const Projected result =
      project(limits(0.5, 10.0), {{0.0f, 0.0f, 0.0f}, {0.3f, 0.3f, 0.2f}, {0.0f, -0.51f, 0.0f}});
  EXPECT_EQ(result.count.too_near, 2u);
  EXPECT_EQ(result.scan.returns.size(), 1u);
  EXPECT_TRUE(result.scan.misses.empty());
}

TEST(PointProjectorTest, RaysAreCutOffAtTheirMaximumLength) {
  const std::vector<Eigen::Vector3f> points = {
      {30.0f, 40.0f, 0.0f}, {0.0f, 0.0f, -4.9f}, {-1e6f, 0.0f, 0.0f}};
  const Projected result = project(limits(0.5, 5.0), points);
  EXPECT_EQ(result.count.too_far, 2u);
  EXPECT_EQ(result.count.returns, 1u);
  ASSERT_EQ(result.scan.misses.size(), 2u);
  EXPECT_LT((result.scan.misses[0] - Eigen::Vector3f(3.0f, 4.0f, 0.0f)).norm(), kPointTolerance);
  EXPECT_LT((result.scan.misses[1] - Eigen::Vector3f(-5.0f, 0.0f, 0.0f)).norm(), kPointTolerance);
}

TEST(PointProjectorTest, RaysStopShortOfSurfacesBeyondTheirMaximumLength) {
  MapperConfig config = limits(0.5, 5.0);
  config.resolution = 0.2;
  config.ray_end_cut = 1.5;
  const Projected result = project(config, {{0.0f, 5.1f, 0.0f}, {0.0f, 0.0f, 5.4f}});
  EXPECT_EQ(result.count.too_far, 2u);
  ASSERT_EQ(result.scan.misses.size(), 2u);
  EXPECT_LT((result.scan.misses[0] - Eigen::Vector3f(0.0f, 4.8f, 0.0f)).norm(), kPointTolerance);
  EXPECT_LT((result.scan.misses[1] - Eigen::Vector3f(0.0f, 0.0f, 5.0f)).norm(), kPointTolerance);
  config.ray_end_cut = 30.0;
  EXPECT_TRUE(project(config, {{0.0f, 5.1f, 0.0f}}).scan.misses.empty());
}

TEST(PointProjectorTest, FarPointsAreIgnoredWhenThePolicySaysSo) {
  const Projected result =
      project(limits(0.5, 5.0, ReadingPolicy::kIgnore), {{30.0f, 40.0f, 0.0f}});
  EXPECT_EQ(result.count.too_far, 1u);
  EXPECT_TRUE(result.scan.misses.empty());
  EXPECT_TRUE(result.scan.returns.empty());
}

TEST(PointProjectorTest, AnEmptyScanIsEmpty) {
  const Projected result = project(limits(0.5, 5.0), {});
  EXPECT_EQ(result.count.total, 0u);
  EXPECT_TRUE(result.scan.returns.empty());
  EXPECT_TRUE(result.scan.misses.empty());
}

TEST(PointProjectorTest, APointExactlyAtALimitIsWithinIt) {
  const Projected result = project(limits(1.0, 8.0), {{1.0f, 0.0f, 0.0f}, {0.0f, -8.0f, 0.0f}});
  EXPECT_EQ(result.count.returns, 2u);
  EXPECT_EQ(result.scan.returns.size(), 2u);
  EXPECT_TRUE(result.scan.misses.empty());
}

}  // namespace
}  // namespace fiimap
