#include "fiimap/ignored_volumes.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/mapper.h"
#include "mapper_fixture.h"
#include "oracle.h"

namespace fiimap {
namespace {

using test::poseAt;
using test::smallConfig;
using test::State;
using Vector = Eigen::Vector3d;

constexpr std::int64_t kSecond = 1000000000;

Vector randomVector(test::Random& random, double reach) {
  return Vector::NullaryExpr(
      [&](Eigen::Index) { return test::uniformReal(random, -reach, reach); });
}

Eigen::Isometry3d randomPose(test::Random& random, const Vector& around) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(test::uniformReal(random, -3.0, 3.0),
                                    randomVector(random, 1.0).normalized())
                      .toRotationMatrix();
  pose.translation() = around + randomVector(random, 0.5);
  return pose;
}

/// How far a point is inside of a volume, m; negative: outside.
double depthInBody(const Vector& size, const Eigen::Isometry3d& T_W_B, const Vector& point_W) {
  const Vector point_B = T_W_B.linear().transpose() * (point_W - T_W_B.translation());
  return (size / 2.0 - point_B.cwiseAbs()).minCoeff();
}
double depthInSphere(const IgnoredSphere& sphere, const Vector& point_W) {
  return sphere.radius - (point_W - sphere.center_W).norm();
}

TEST(IgnoredVolumesTest, TakesTheReturnsInTheVolumesAwayAndNoOthers) {
  constexpr double kRounding = 1e-5;  // m, of a return
  test::Random random(571);
  std::size_t removed_in_all = 0, kept_in_all = 0;
  for (int round = 0; round < test::effort(300); ++round) {
    SCOPED_TRACE("seed 571, round " + std::to_string(round));
    const Vector place = randomVector(random, round % 3 == 0 ? 1e6 : 10.0);
    const bool has_body = test::chance(random, 0.7);
    const Vector size =
        has_body ? Vector(Vector(1.1, 1.1, 1.1) + randomVector(random, 1.0)) : Vector(0, 0, 0);
    const Eigen::Isometry3d T_W_B = randomPose(random, place);
    IgnoredVolumes volumes(size);
    const std::int64_t stamp = 100 * kSecond;
    std::vector<IgnoredSphere> counting;
    for (int i = test::uniformInt(random, 0, 4); i > 0; --i) {
      IgnoredSphere sphere;
      sphere.center_W = place + randomVector(random, 2.0);
      sphere.radius = test::uniformReal(random, 0.1, 1.5);
      sphere.stamp_ns = stamp + test::uniformInt(random, -2, 2) * kSecond;
      sphere.lifetime_ns = test::uniformInt(random, 0, 2) * kSecond;
      if (std::abs(sphere.stamp_ns - stamp) <= sphere.lifetime_ns) counting.push_back(sphere);
      volumes.add({sphere});
    }
    RangeData scan;
    scan.origin = place + randomVector(random, 0.3);
    scan.misses.push_back({0.1f, 0.0f, 0.0f});
    std::vector<Eigen::Vector3f> expected;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3f point = randomVector(random, 2.0).cast<float>();
      const Vector point_W = scan.origin + point.cast<double>();
      double depth = has_body ? depthInBody(size, T_W_B, point_W) : -1.0;
      for (const IgnoredSphere& sphere : counting) {
        depth = std::max(depth, depthInSphere(sphere, point_W));
      }
      if (std::abs(depth) < kRounding) continue;
      scan.returns.push_back(point);
      if (depth < 0.0) expected.push_back(point);
    }
    const std::size_t before = scan.returns.size();
    const std::size_t removed = volumes.removeReturns(T_W_B, stamp, &scan);
    ASSERT_EQ(test::toVector(scan.returns), expected) << "in their order";
    ASSERT_EQ(removed, before - expected.size());
    ASSERT_EQ(scan.misses.size(), 1u);
    removed_in_all += removed;
    kept_in_all += expected.size();
  }
  EXPECT_GT(removed_in_all, static_cast<std::size_t>(test::effort(1000)));
  EXPECT_GT(kept_in_all, static_cast<std::size_t>(test::effort(1000)));
}

TEST(IgnoredVolumesTest, KeepsTheSpheresThatWereAddedLast) {
  IgnoredVolumes volumes(Vector::Zero());
  IgnoredSphere first, other;
  first.radius = other.radius = 0.1;
  other.center_W = {5.0, 0.0, 0.0};
  volumes.add({first});
  const auto removesFirst = [&] {
    RangeData scan;
    scan.returns.push_back({0.0f, 0.0f, 0.0f});
    return volumes.removeReturns(Eigen::Isometry3d::Identity(), 0, &scan) == 1;
  };
  volumes.add(std::vector<IgnoredSphere>(IgnoredVolumes::kMaxSpheres - 1, other));
  EXPECT_TRUE(removesFirst());
  volumes.add({other});
  EXPECT_FALSE(removesFirst());
}

/// A map with what is ignored is the map of the scans without it.
TEST(IgnoredVolumesTest, AnIgnoredReadingIsAsIfItHadNotBeenMade) {
  constexpr double kRounding = 1e-4;
  test::Random random(572);
  std::size_t ignored = 0;
  for (int flight = 0; flight < test::effort(20); ++flight) {
    MapperConfig config = smallConfig();
    const Vector size(0.8, 0.6, 0.4);
    Mapper without(config);
    config.body_size_x = size.x();
    config.body_size_y = size.y();
    config.body_size_z = size.z();
    Mapper ignoring(config);
    Vector place = randomVector(random, 20.0);
    for (int i = 1; i <= 10; ++i) {
      SCOPED_TRACE("seed 572, flight " + std::to_string(flight) + ", scan " + std::to_string(i));
      place += randomVector(random, 0.3);
      const Eigen::Isometry3d T_W_B = randomPose(random, place);
      ScanPose pose;
      pose.vehicle_W = T_W_B.translation();
      pose.R_W_B = T_W_B.linear();
      pose.T_W_S = T_W_B;
      pose.stamp_ns = i * kSecond;
      IgnoredSphere sphere;
      sphere.center_W = place + randomVector(random, 1.5);
      sphere.radius = 0.5;
      sphere.stamp_ns = pose.stamp_ns;
      ignoring.ignore({sphere});
      PointScan all, others;
      for (int k = 0; k < 60; ++k) {
        const Eigen::Vector3f point = randomVector(random, 2.0).cast<float>();
        const Vector point_W = pose.T_W_S * point.cast<double>();
        const double depth =
            std::max(depthInBody(size, T_W_B, point_W), depthInSphere(sphere, point_W));
        if (std::abs(depth) < kRounding) continue;
        all.points.push_back(point);
        if (depth < 0.0) others.points.push_back(point);
      }
      const ScanReport report = ignoring.integrate(all, pose);
      without.integrate(others, pose);
      ASSERT_EQ(report.readings.total, all.points.size());
      ASSERT_LE(report.readings.ignored, all.points.size() - others.points.size());
      ignored += report.readings.ignored;
      ASSERT_TRUE(State(&ignoring) == State(&without));
    }
  }
  EXPECT_GT(ignored, static_cast<std::size_t>(test::effort(50)));
}

TEST(IgnoredVolumesTest, RaysThroughAVolumeFreeWhatTheyPass) {
  Mapper mapper(smallConfig());
  IgnoredSphere sphere;
  sphere.center_W = {1.125, 0.125, 0.125};
  sphere.radius = 0.5;
  sphere.lifetime_ns = kSecond;
  mapper.ignore({sphere});
  mapper.integrate({{Eigen::Vector3f(2.0f, 0.0f, 0.0f)}}, poseAt({0.125, 0.125, 0.125}));
  EXPECT_EQ(mapper.snapshot()->occupancy(sphere.center_W), Occupancy::kFree);
  mapper.integrate({{Eigen::Vector3f(1.0f, 1.0f, 0.0f)}}, poseAt({0.125, 0.125, 0.125}));
  EXPECT_EQ(mapper.snapshot()->occupancy(Vector(0.625, 0.625, 0.125)), Occupancy::kFree)
      << "a return outside of it";
}

TEST(IgnoredVolumesTest, AResetForgetsSpheres) {
  Mapper mapper(smallConfig());
  IgnoredSphere sphere;
  sphere.center_W = {2.125, 0.125, 0.125};
  sphere.radius = 0.5;
  sphere.lifetime_ns = kSecond;
  mapper.ignore({sphere});
  test::seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  EXPECT_EQ(mapper.snapshot()->count(Plane::kKnown), 0);
  mapper.reset();
  test::seeAnObstacle(&mapper, {0.125, 0.125, 0.125});
  EXPECT_EQ(mapper.snapshot()->count(Plane::kOccupied), 1);
}

/// The body's voxels are as if a ray had passed each of them in every scan.
TEST(IgnoredVolumesTest, TheBodyIsFreeWhereItIsToBeCleared) {
  test::Random random(573);
  for (int round = 0; round < test::effort(40); ++round) {
    SCOPED_TRACE("seed 573, round " + std::to_string(round));
    MapperConfig config = smallConfig();
    config.body_size_x = 1.2;
    config.body_size_y = 0.9;
    config.body_size_z = 0.7;
    config.clear_body = true;
    Mapper mapper(config);
    const Eigen::Isometry3d T_W_B = randomPose(random, randomVector(random, 20.0));
    ScanPose pose;
    pose.vehicle_W = T_W_B.translation();
    pose.R_W_B = T_W_B.linear();
    pose.T_W_S = T_W_B;
    mapper.placeWindow(pose.vehicle_W);
    const VoxelBox window = mapper.grid().window();
    mapper.overwrite({window}, Occupancy::kOccupied);
    const int scans = mapper.logOdds().missesToClear();
    for (int i = 1; i <= scans; ++i) {
      const ScanReport report = mapper.integrate(PointScan(), pose);
      ASSERT_EQ(report.raise > 0, i == scans) << i;
    }
    const VoxelLattice lattice(config.resolution);
    test::VoxelSet occupied;
    int freed = 0;
    const auto snapshot = mapper.snapshot();
    test::forEachVoxel(window, [&](const VoxelIndex& v) {
      const double depth = depthInBody({1.2, 0.9, 0.7}, T_W_B, lattice.centerOf(v));
      const bool is_free = snapshot->occupancy(v) == Occupancy::kFree;
      if (std::abs(depth) > 1e-9) {
        EXPECT_EQ(is_free, depth > 0.0) << test::describe(v);
      }
      freed += is_free;
      if (!is_free) occupied.insert(v);
    });
    EXPECT_GT(freed, 0);
    const test::ElementDefinition element{ElementShape::kBall, 500, 250};
    EXPECT_TRUE(test::planeEquals(mapper.grid(), Plane::kInflated,
                                  test::dilate(occupied, element.offsets(), window)));
  }
}

}  // namespace
}  // namespace fiimap
