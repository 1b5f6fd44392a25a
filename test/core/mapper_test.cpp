#include "fiimap/mapper.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "mapper_fixture.h"
#include "oracle.h"

namespace fiimap {
namespace {

using test::centerOfWindow;
using test::kResolution;
using test::poseAt;
using test::seeAnObstacle;
using test::smallConfig;
using test::State;

TEST(MapperTest, WindowHasTheConfiguredSizeAroundTheVehicle) {
  Mapper mapper(smallConfig());
  mapper.integrate(PointScan(), poseAt({-1234.5, 77.7, -3.3}));
  EXPECT_EQ(mapper.grid().window().size(), VoxelIndex(32, 24, 12));
  EXPECT_LT((centerOfWindow(mapper) - Eigen::Vector3d(-1234.5, 77.7, -3.3)).cwiseAbs().maxCoeff(),
            kResolution);
}

TEST(MapperTest, SeesAnObstacleAndTheFreeSpaceBeforeIt) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  const auto snapshot = mapper.snapshot();
  EXPECT_EQ(snapshot->voxels(Plane::kOccupied, snapshot->window()),
            (std::vector<VoxelIndex>{{8, 0, 0}}));
  for (int x = 0; x < 8; ++x) {
    EXPECT_EQ(snapshot->occupancy(VoxelIndex(x, 0, 0)), Occupancy::kFree) << x;
  }
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(9, 0, 0)), Occupancy::kUnknown);
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(4, 1, 0)), Occupancy::kUnknown);
  EXPECT_EQ(snapshot->count(Plane::kInflated), 33) << "a ball of two voxels";
  EXPECT_EQ(snapshot->inflation(VoxelIndex(6, 0, 0)), Inflation::kInflated);
  EXPECT_EQ(snapshot->inflation(VoxelIndex(5, 0, 0)), Inflation::kFree);
  EXPECT_EQ(snapshot->inflation(VoxelIndex(10, 0, 0)), Inflation::kInflated);
}

TEST(MapperTest, WindowFollowsPerAxisBeyondTheSlideDistance) {
  // Less and more than the distance of 1 m, by more than one voxel.
  constexpr double kWithin = 0.7, kBeyond = 1.3;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      Mapper mapper(smallConfig());
      const Eigen::Vector3d start(0.125, 0.125, 0.125);
      mapper.integrate(PointScan(), poseAt(start));
      const VoxelBox window = mapper.grid().window();

      Eigen::Vector3d position = start + Eigen::Vector3d(kWithin, -kWithin, kWithin);
      mapper.integrate(PointScan(), poseAt(position));
      EXPECT_EQ(mapper.grid().window(), window) << "axis " << axis << ", side " << side;

      position[axis] = start[axis] + side * kBeyond;
      mapper.integrate(PointScan(), poseAt(position));
      for (int other = 0; other < 3; ++other) {
        const int moved = mapper.grid().window().min[other] - window.min[other];
        const double expected = other == axis ? side * kBeyond / kResolution : 0.0;
        EXPECT_NEAR(moved, expected, other == axis ? 1.0 : 0.0)
            << "axis " << axis << ", side " << side << ", moved along " << other;
      }
      EXPECT_LT(std::abs(centerOfWindow(mapper)[axis] - position[axis]), kResolution);
    }
  }
}

TEST(MapperTest, WindowFollowsFromTheSlideDistanceOn) {
  Mapper mapper(smallConfig());
  const Eigen::Vector3d start(0.125, 0.125, 0.125);
  mapper.integrate(PointScan(), poseAt(start));
  const VoxelIndex before = mapper.grid().window().min;
  const Eigen::Vector3d along_y = Eigen::Vector3d::UnitY();
  mapper.integrate(PointScan(), poseAt(start + (1.0 - kResolution) * along_y));
  EXPECT_EQ(mapper.grid().window().min, before);
  mapper.integrate(PointScan(), poseAt(start + 1.0 * along_y));
  EXPECT_EQ(mapper.grid().window().min, before + VoxelIndex(0, 4, 0));
}

TEST(MapperTest, FixedWindowStaysWhereTheConfigurationPutsIt) {
  MapperConfig config = smallConfig();
  config.map_mode = MapMode::kFixed;
  config.map_center_x = -20.0;
  config.map_center_y = 5.0;
  config.map_center_z = 1.5;
  Mapper mapper(config);
  const Eigen::Vector3d center(-20.0, 5.0, 1.5);
  seeAnObstacle(&mapper, center, {1.0f, 0.0f, 0.0f});
  const VoxelBox window = mapper.grid().window();
  EXPECT_LE((centerOfWindow(mapper) - center).cwiseAbs().maxCoeff(), kResolution);
  EXPECT_EQ(mapper.grid().count(Plane::kOccupied), 1);
  for (const double far : {2.0, 3.9, 50.0, -1e6}) {
    seeAnObstacle(&mapper, center + Eigen::Vector3d(far, far, -far));
    EXPECT_EQ(mapper.grid().window(), window);
  }
  EXPECT_GE(mapper.grid().count(Plane::kOccupied), 1) << "nothing is forgotten";
  mapper.reset();
  mapper.integrate(PointScan(), poseAt({0.0, 0.0, 0.0}));
  EXPECT_EQ(mapper.grid().window(), window);
}

TEST(MapperTest, ScansChangeTheLocalUpdateRangeOnly) {
  MapperConfig config = smallConfig();
  config.local_update_range_x = 2.0;
  config.local_update_range_y = 3.0;
  config.local_update_range_z = 1.0;
  Mapper mapper(config);
  PointScan points;
  test::Random random(101);
  for (int i = 0; i < 300; ++i) {
    points.points.push_back(Eigen::Vector3f::NullaryExpr(
        [&](Eigen::Index) { return static_cast<float>(test::uniformReal(random, -4.0, 4.0)); }));
  }
  for (int i = 0; i < 4; ++i) mapper.integrate(points, poseAt({0.125, 0.125, 0.125}));
  const auto snapshot = mapper.snapshot();
  EXPECT_GT(snapshot->count(Plane::kKnown), 50);
  for (const VoxelIndex& v : snapshot->voxels(Plane::kKnown, snapshot->window())) {
    EXPECT_TRUE((VoxelBox{{-4, -6, -2}, {5, 7, 3}}.contains(v))) << test::describe(v);
  }
}

TEST(MapperTest, TeleportForgetsEverything) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  const ScanReport report = mapper.integrate(PointScan(), poseAt({-5000.0, 0.1, 0.1}));
  EXPECT_EQ(report.forgotten, 1u);
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    EXPECT_EQ(mapper.grid().count(plane), 0);
  }
  mapper.integrate(PointScan(), poseAt({0.1, 0.1, 0.1}));
  EXPECT_EQ(mapper.grid().count(Plane::kKnown), 0) << "and it stays forgotten";
}

TEST(MapperTest, ResetForgetsEverythingAndGoesOn) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  const auto before = mapper.snapshot();
  mapper.reset();
  const auto after = mapper.snapshot();
  EXPECT_EQ(after->info().sequence, before->info().sequence + 1) << "a reset does not restart it";
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    EXPECT_EQ(after->count(plane), 0);
    EXPECT_GT(before->count(plane), 0) << "the older snapshot stays as it was";
  }
  EXPECT_EQ(mapper.integrate({{{2.0f, 0.0f, 0.0f}}}, poseAt({9.1, 0.1, 0.1})).lower, 0u)
      << "certainty is forgotten too";
  EXPECT_LT((centerOfWindow(mapper) - Eigen::Vector3d(9.1, 0.1, 0.1)).cwiseAbs().maxCoeff(),
            kResolution);
}

TEST(MapperTest, MemoryStaysBoundedOverTenKilometres) {
  Mapper mapper(smallConfig());
  test::Random random(102);
  std::size_t largest_at_first = 0, largest_later = 0;
  // Out into negative coordinates and back up again.
  constexpr int kScans = 8000;
  for (int i = 0; i < kScans; ++i) {
    PointScan points;
    for (int k = 0; k < 8; ++k) {
      points.points.push_back(Eigen::Vector3f::NullaryExpr(
          [&](Eigen::Index) { return static_cast<float>(test::uniformReal(random, -3.0, 3.0)); }));
    }
    const double s = 1.25 * i;
    mapper.integrate(points, poseAt({-0.7 * s, 0.6 * s - 4000.0, 20.0 * std::sin(s / 50.0)}));
    if (i % 5 == 0) mapper.snapshot();
    std::size_t& largest = i < kScans / 4 ? largest_at_first : largest_later;
    largest = std::max(largest, mapper.memoryBytes());
  }
  EXPECT_LE(largest_later, largest_at_first);
  EXPECT_LE(mapper.grid().memoryBytes(), mapper.grid().worstCaseMemoryBytes());
  EXPECT_GT(mapper.grid().count(Plane::kKnown), 0);
}

TEST(MapperTest, SnapshotsCarryStampSequenceAndSettings) {
  MapperConfig config = smallConfig();
  config.inflation_shape = ElementShape::kCube;
  config.virtual_walls = true;
  config.virtual_floor = -0.4;
  config.virtual_ceiling = 1.1;
  Mapper mapper(config);
  mapper.integrate(PointScan(), poseAt({0.0, 0.0, 0.0}, 1600000000123456789));
  const auto first = mapper.snapshot();
  EXPECT_EQ(first->info().stamp_ns, 1600000000123456789);
  EXPECT_EQ(first->info().sequence, 1u);
  EXPECT_EQ(first->info().resolution, kResolution);
  EXPECT_EQ(first->info().inflation_radius, 0.5);
  EXPECT_EQ(first->info().inflation_shape, ElementShape::kCube);
  EXPECT_EQ(first->occupancy(Eigen::Vector3d(0.0, 0.0, -0.45)), Occupancy::kOccupied);
  EXPECT_EQ(first->occupancy(Eigen::Vector3d(0.0, 0.0, 1.15)), Occupancy::kOccupied);
  EXPECT_EQ(first->occupancy(Eigen::Vector3d(0.0, 0.0, 0.5)), Occupancy::kUnknown);
  mapper.integrate(PointScan(), poseAt({0.0, 0.0, 0.0}, 1600000000200000000));
  EXPECT_EQ(mapper.snapshot()->info().sequence, 2u);
  EXPECT_EQ(mapper.snapshot()->info().stamp_ns, 1600000000200000000);
}

TEST(MapperTest, AnOlderScanTurnsNeitherTheWindowNorTheStampBack) {
  Mapper mapper(smallConfig());
  const PointScan ahead = {{{1.0f, 0.0f, 0.0f}}};
  const auto position = [](int k) { return Eigen::Vector3d(1.5 * k + 0.125, 0.125, 0.125); };
  constexpr std::int64_t kStep = 100;  // ns
  constexpr int kScans = 6;
  for (int k = 1; k <= kScans; ++k) {
    mapper.integrate(PointScan(), poseAt(position(k), k * kStep));
    const VoxelBox window = mapper.grid().window();
    // Another sensor's scan, which took longer to come.
    const ScanReport report = mapper.integrate(ahead, poseAt(position(k - 1), (k - 1) * kStep + 1));
    EXPECT_EQ(report.rays.hits, 1u) << k;
    EXPECT_EQ(report.forgotten, 0u) << k;
    EXPECT_EQ(mapper.grid().window(), window) << k;
    EXPECT_EQ(mapper.snapshot()->info().stamp_ns, k * kStep);
  }
  const Eigen::Vector3d free = position(kScans - 1) + Eigen::Vector3d(0.5, 0.0, 0.0);
  EXPECT_EQ(mapper.snapshot()->occupancy(free), Occupancy::kFree) << "and it is in the map";
}

TEST(MapperTest, AfterAResetTimeMayBeginAgain) {
  Mapper mapper(smallConfig());
  mapper.integrate(PointScan(), poseAt({0.125, 0.125, 0.125}, 900));
  mapper.reset();
  EXPECT_EQ(mapper.snapshot()->info().stamp_ns, 0);
  for (const std::int64_t stamp : {5, 6}) {
    const Eigen::Vector3d position(20.0 * static_cast<double>(stamp), 0.125, 0.125);
    mapper.integrate(PointScan(), poseAt(position, stamp));
    EXPECT_EQ(mapper.snapshot()->info().stamp_ns, stamp);
    EXPECT_LT((centerOfWindow(mapper) - position).cwiseAbs().maxCoeff(), kResolution);
  }
}

TEST(MapperTest, WallsAreOffUnlessAskedFor) {
  MapperConfig config = smallConfig();
  config.virtual_floor = -0.4;
  Mapper mapper(config);
  mapper.integrate(PointScan(), poseAt({0.0, 0.0, 0.0}));
  EXPECT_EQ(mapper.snapshot()->occupancy(Eigen::Vector3d(0.0, 0.0, -0.45)), Occupancy::kUnknown);
}

TEST(MapperTest, ChangesItsInflationAtOnce) {
  Mapper mapper(smallConfig());
  seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  ASSERT_EQ(mapper.grid().count(Plane::kInflated), 33);
  mapper.reconfigure(test::withInflation(mapper.config(), 0.25, ElementShape::kCube));
  EXPECT_EQ(mapper.grid().count(Plane::kInflated), 27);
  EXPECT_EQ(mapper.snapshot()->info().inflation_radius, 0.25);
  EXPECT_EQ(mapper.config().inflation_shape, ElementShape::kCube);
  mapper.reconfigure(test::withInflation(mapper.config(), 0.5, ElementShape::kDiamond));
  EXPECT_EQ(mapper.grid().count(Plane::kInflated), 25);
  mapper.reconfigure(test::withInflation(mapper.config(), 0.0, ElementShape::kBall));
  EXPECT_EQ(mapper.grid().count(Plane::kInflated), 1);
}

TEST(MapperTest, EachOfSeveralSensorsIsReadAsItIsConfigured) {
  MapperConfig config = smallConfig();
  config.sensors.assign(2, config);
  config.sensors[1].max_ray_length = 1.5;
  config.sensors[1].beyond_max_depth = ReadingPolicy::kIgnore;
  const PointScan scan = {{{2.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
  const ScanPose pose = poseAt({0.1, 0.1, 0.1});
  for (std::size_t sensor = 0; sensor < config.sensors.size(); ++sensor) {
    Mapper several(config), one(config.withOnly(sensor));
    for (int i = 0; i < 3; ++i) {
      several.integrate(scan, pose, sensor);
      one.integrate(scan, pose);
    }
    EXPECT_EQ(several.grid().count(Plane::kOccupied), sensor == 0 ? 2 : 1);
    EXPECT_TRUE(State(&several) == State(&one)) << sensor;
  }
  EXPECT_THROW(Mapper(config).integrate(scan, pose, 2), std::out_of_range);
}

TEST(MapperTest, ImagesOfSeveralSensorsToo) {
  MapperConfig config = smallConfig();
  config.border_margin = 0;
  config.sensors.assign(2, config);
  config.sensors[1].depth_scale = 0.0005;
  const std::vector<std::uint16_t> pixels(8 * 8, 1000);  // upwards, 1 m or 0.5 m
  const DepthImage image = {pixels.data(), DepthImage::Format::kUint16, 8, 8, 16};
  const PinholeIntrinsics intrinsics = {8.0, 8.0, 4.0, 4.0};
  for (std::size_t sensor = 0; sensor < config.sensors.size(); ++sensor) {
    Mapper several(config), one(config.withOnly(sensor));
    for (int i = 0; i < 3; ++i) {
      several.integrate(image, intrinsics, poseAt({0.1, 0.1, 0.1}), sensor);
      one.integrate(image, intrinsics, poseAt({0.1, 0.1, 0.1}));
    }
    EXPECT_GT(several.grid().count(Plane::kOccupied), 0);
    EXPECT_TRUE(State(&several) == State(&one)) << sensor;
  }
}

}  // namespace
}  // namespace fiimap
