#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fiimap/mapper.h"
#include "mapper_fixture.h"

/// What a mapper refuses, with its map unchanged.
namespace fiimap {
namespace {

using test::kResolution;
using test::poseAt;
using test::seeAnObstacle;
using test::smallConfig;
using test::State;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MapperRefusalTest, RefusesABadConfiguration) {
  MapperConfig config = smallConfig();
  config.resolution = 0.0;
  EXPECT_THROW(Mapper{config}, std::invalid_argument);
  config = smallConfig();
  config.p_occ = 0.99;
  EXPECT_THROW(Mapper{config}, std::invalid_argument);
}

/// Poses that must be refused.
std::vector<ScanPose> badPoses() {
  std::vector<ScanPose> poses;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kNan, kInf, -kInf, 1e300, 2147483648.0 * kResolution}) {
      poses.push_back(poseAt({0.0, 0.0, 0.0}));
      poses.back().T_W_S.translation()[axis] = bad;
      poses.push_back(poseAt({0.0, 0.0, 0.0}));
      poses.back().vehicle_W[axis] = bad;
    }
    poses.push_back(poseAt({0.0, 0.0, 0.0}));
    poses.back().T_W_S.linear()(axis, 1) = kNan;
    poses.push_back(poseAt({0.0, 0.0, 0.0}));
    poses.back().T_W_S.linear()(axis, axis) = -1.0;  // a mirror
    poses.push_back(poseAt({0.0, 0.0, 0.0}));
    poses.back().T_W_S.linear()(axis, axis) = 1.01;  // stretches
  }
  poses.push_back(poseAt({0.0, 0.0, 0.0}));
  poses.back().T_W_S.linear().setZero();
  return poses;
}

TEST(MapperRefusalTest, RefusesABadPoseAndKeepsItsMap) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  const State before(&mapper);
  const std::uint16_t pixel = 1000;
  const DepthImage image{&pixel, DepthImage::Format::kUint16, 1, 1, 2};
  for (ScanPose pose : badPoses()) {
    pose.stamp_ns = 99;
    const PointScan points{{{1.0f, 1.0f, 0.0f}}};
    EXPECT_THROW(mapper.integrate(points, pose), std::invalid_argument);
    EXPECT_THROW(mapper.integrate(image, {1.0, 1.0, 0.0, 0.0}, pose), std::invalid_argument);
    EXPECT_TRUE(State(&mapper) == before);
    EXPECT_EQ(mapper.snapshot()->info().stamp_ns, 1);
  }
  seeAnObstacle(&mapper, {0.1, 0.1, 0.1}, {0.0f, 2.0f, 0.0f});
  EXPECT_EQ(mapper.grid().count(Plane::kOccupied), 2) << "and goes on";
}

TEST(MapperRefusalTest, RefusesABadImageAndKeepsItsMap) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  const State before(&mapper);
  const std::vector<std::uint16_t> pixels(64, 1000);
  const DepthImage good{pixels.data(), DepthImage::Format::kUint16, 8, 8, 16};
  const PinholeIntrinsics camera{10.0, 10.0, 4.0, 4.0};
  const auto expectRefused =
      [&](const std::function<void(DepthImage*, PinholeIntrinsics*)>& spoil) {
        DepthImage image = good;
        PinholeIntrinsics intrinsics = camera;
        spoil(&image, &intrinsics);
        EXPECT_THROW(mapper.integrate(image, intrinsics, poseAt({3.0, 3.0, 3.0})),
                     std::invalid_argument);
        EXPECT_TRUE(State(&mapper) == before);
      };
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->data = nullptr; });
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->width = 0; });
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->width = -8; });
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->height = 0; });
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->height = -1; });
  expectRefused([](DepthImage* i, PinholeIntrinsics*) { i->row_bytes = 15; });
  expectRefused(
      [](DepthImage* i, PinholeIntrinsics*) { i->format = DepthImage::Format::kFloat32; });
  expectRefused([](DepthImage*, PinholeIntrinsics* k) { k->fx = 0.0; });
  expectRefused([](DepthImage*, PinholeIntrinsics* k) { k->fy = kNan; });
  expectRefused([](DepthImage*, PinholeIntrinsics* k) { k->cx = kInf; });
  EXPECT_NO_THROW(mapper.integrate(good, camera, poseAt({3.0, 3.0, 3.0})));
}

TEST(MapperRefusalTest, RefusesABadInflationAndKeepsTheOldOne) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  for (const double bad : {-0.1, kNan, kInf, 1000.0, 17.0}) {
    EXPECT_THROW(mapper.reconfigure(test::withInflation(smallConfig(), bad, ElementShape::kCube)),
                 std::invalid_argument)
        << bad;
    EXPECT_EQ(mapper.config().inflation_radius, 0.5);
    EXPECT_EQ(mapper.config().inflation_shape, ElementShape::kBall);
    EXPECT_EQ(mapper.grid().count(Plane::kInflated), 33);
  }
}

}  // namespace
}  // namespace fiimap
