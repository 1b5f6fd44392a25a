#include "fiimap/ros/map_queries.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "../core/oracle.h"
#include "fiimap/ros/geometry_messages.h"

namespace fiimap {
namespace {

constexpr double kBoxResolution = 0.5;
constexpr int kInflatedFactor = 4;

class MapQueriesTest : public testing::Test {
 protected:
  MapQueriesTest() : grid_(VoxelIndex(8, 6, 4)) {}

  Snapshot snapshot() {
    Snapshot::Info info;
    info.stamp_ns = 1600000000123456789;
    info.resolution = kBoxResolution;
    return Snapshot(&grid_, info);
  }
  static GetBox::Request request(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    GetBox::Request request;
    request.min = toPoint(min);
    request.max = toPoint(max);
    return request;
  }
  std::string refusal(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    const GetBox::Response response = queryBox(snapshot(), request(min, max), "map");
    EXPECT_NE(response.success, !response.message.empty());
    EXPECT_EQ(response.voxels.empty(), !response.success);
    return response.message;
  }

  /// Every state in every layer here and there.
  void fillAtRandom(test::Random* random) {
    test::forEachVoxel(grid_.window(), [&](const VoxelIndex& v) {
      const int state = test::uniformInt(*random, 0, 3);
      grid_.set(Plane::kKnown, v, state > 0);
      grid_.set(Plane::kOccupied, v, state > 1);
      grid_.set(Plane::kInflated, v, state > 1 || test::uniformInt(*random, 0, 1) == 1);
    });
  }
  /// A point in the window or beside it.
  Eigen::Vector3d randomPoint(test::Random* random) const {
    return {test::uniformReal(*random, -3.0, 3.0), test::uniformReal(*random, -2.0, 2.0),
            test::uniformReal(*random, -1.5, 1.5)};
  }
  static CastRays::Request rays(std::uint8_t layer, std::uint8_t unknown, std::uint8_t outside) {
    CastRays::Request request;
    request.layer = layer;
    request.unknown = unknown;
    request.outside = outside;
    return request;
  }
  std::string rayRefusal(const CastRays::Request& request) {
    const CastRays::Response response = castRays(snapshot(), request, "map");
    EXPECT_NE(response.success, !response.message.empty());
    EXPECT_TRUE(response.success || response.hit.empty());
    return response.message;
  }

  SlidingGrid grid_;
};

TEST_F(MapQueriesTest, TellsBothLayersOfEveryVoxel) {
  test::Random random(551);
  const VoxelBox window = grid_.window();
  fillAtRandom(&random);
  const Snapshot map = snapshot();
  // One voxel more than the window at each side, from points within the first and last ones.
  const VoxelBox box{window.min.array() - 1, window.max.array() + 1};
  const GetBox::Response response = queryBox(
      map, request(map.lattice().centerOf(box.min), map.lattice().centerOf(box.max.array() - 1)),
      "map");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.header.frame_id, "map");
  EXPECT_EQ(response.header.stamp.toNSec(), 1600000000123456789u);
  EXPECT_EQ(response.resolution, kBoxResolution);
  EXPECT_EQ(response.origin.x, box.min.x() * kBoxResolution);
  EXPECT_EQ(response.origin.y, box.min.y() * kBoxResolution);
  EXPECT_EQ(response.origin.z, box.min.z() * kBoxResolution);
  ASSERT_EQ((VoxelIndex(response.size_x, response.size_y, response.size_z)), box.size());
  ASSERT_EQ(response.voxels.size(), static_cast<std::size_t>(box.volume()));
  test::forEachVoxel(box, [&](const VoxelIndex& v) {
    const VoxelIndex at = v - box.min;
    const int state = response.voxels[at.z() + box.size().z() * (at.y() + box.size().y() * at.x())];
    EXPECT_EQ(state % kInflatedFactor, static_cast<int>(map.occupancy(v)));
    EXPECT_EQ(state / kInflatedFactor, static_cast<int>(map.inflation(v)));
  });
}

TEST_F(MapQueriesTest, APointIsABoxOfOneVoxel) {
  const GetBox::Response response =
      queryBox(snapshot(), request({0.2, 0.2, 0.2}, {0.2, 0.2, 0.2}), "map");
  ASSERT_TRUE(response.success);
  EXPECT_EQ(response.voxels.size(), 1u);
}

TEST_F(MapQueriesTest, BadBoxesAreRefusedWithTheReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_EQ(refusal(zero, zero), "");
  EXPECT_NE(refusal({nan, 0, 0}, zero).find("finite"), std::string::npos);
  EXPECT_NE(refusal(zero, {0, infinity, 0}).find("finite"), std::string::npos);
  EXPECT_NE(refusal(zero, {0, 0, 1e300}).find("finite"), std::string::npos);
  EXPECT_NE(refusal({1, 0, 0}, zero).find("less than min"), std::string::npos);
  EXPECT_NE(refusal(zero, {1e4, 1e4, 1e4}).find("at most 16777216"), std::string::npos);
  // All voxels that have an index: their number along an axis is none.
  constexpr double kLastIndex = (1 << 30) - 0.5;
  const Eigen::Vector3d end = Eigen::Vector3d::Constant(kLastIndex * kBoxResolution);
  EXPECT_NE(refusal(-end, end).find("at most 16777216"), std::string::npos);
}

TEST_F(MapQueriesTest, ManyPointsHaveTheStatesThatEachHas) {
  test::Random random(552);
  fillAtRandom(&random);
  const Snapshot map = snapshot();
  QueryPoints::Request request;
  std::vector<Eigen::Vector3d> points_W = {{std::nan(""), 0, 0}, {0, 1e300, 0}};
  for (int i = 0; i < 500; ++i) points_W.push_back(randomPoint(&random));
  for (const Eigen::Vector3d& p_W : points_W) request.points.push_back(toPoint(p_W));
  const QueryPoints::Response response = queryPoints(map, request, "map");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.header.frame_id, "map");
  EXPECT_EQ(response.header.stamp.toNSec(), 1600000000123456789u);
  ASSERT_EQ(response.states.size(), points_W.size());
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    EXPECT_EQ(response.states[i] % kInflatedFactor, static_cast<int>(map.occupancy(points_W[i])));
    EXPECT_EQ(response.states[i] / kInflatedFactor, static_cast<int>(map.inflation(points_W[i])));
  }
  EXPECT_EQ(response.states[0], 15) << "outside in both layers";
}

TEST_F(MapQueriesTest, NoPointsAreAnsweredAndTooManyAreRefused) {
  QueryPoints::Request request;
  EXPECT_TRUE(queryPoints(snapshot(), request, "map").success);
  request.points.resize((1 << 20) + 1);
  const QueryPoints::Response response = queryPoints(snapshot(), request, "map");
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("points must be at most 1048576"), std::string::npos);
  EXPECT_TRUE(response.states.empty());
}

TEST_F(MapQueriesTest, RaysAreThoseOfTheSnapshot) {
  using Request = CastRays::Request;
  test::Random random(553);
  fillAtRandom(&random);
  // Mostly free, so that rays get somewhere.
  test::forEachVoxel(grid_.window(), [&](const VoxelIndex& v) {
    if (test::chance(random, 0.8)) grid_.set(Plane::kOccupied, v, false);
    if (test::chance(random, 0.8)) grid_.set(Plane::kInflated, v, false);
  });
  const Snapshot map = snapshot();
  int hits = 0, free = 0;
  for (const auto layer : {Request::INFLATED, Request::RAW}) {
    for (const auto unknown : {Request::OBSTACLE, Request::FREE}) {
      for (const auto outside : {Request::OBSTACLE, Request::FREE}) {
        Request request = rays(layer, unknown, outside);
        for (int i = 0; i < 100; ++i) {
          request.starts.push_back(toPoint(randomPoint(&random)));
          request.ends.push_back(toPoint(randomPoint(&random)));
        }
        const ObstacleRules rules{layer == Request::RAW ? MapLayer::kRaw : MapLayer::kInflated,
                                  unknown == Request::FREE ? Unseen::kFree : Unseen::kObstacle,
                                  outside == Request::FREE ? Unseen::kFree : Unseen::kObstacle};
        const CastRays::Response response = castRays(map, request, "map");
        ASSERT_TRUE(response.success) << response.message;
        EXPECT_EQ(response.header.frame_id, "map");
        ASSERT_EQ(response.hit.size(), request.starts.size());
        ASSERT_EQ(response.points.size(), request.starts.size());
        ASSERT_EQ(response.distances.size(), request.starts.size());
        for (std::size_t i = 0; i < request.starts.size(); ++i) {
          const Eigen::Vector3d from = toEigen(request.starts[i]), to = toEigen(request.ends[i]);
          const std::optional<RayHit> hit = map.castRay(from, to, rules);
          ++(hit ? hits : free);
          ASSERT_EQ(response.hit[i] != 0, hit.has_value());
          EXPECT_EQ(toEigen(response.points[i]), hit ? hit->point_W : to);
          EXPECT_EQ(response.distances[i], hit ? hit->distance : (to - from).norm());
        }
      }
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(free, 50);
}

TEST_F(MapQueriesTest, RaysThatAreNotSaidInFullOrAreAbsurdAreRefusedWithTheReason) {
  using Request = CastRays::Request;
  const geometry_msgs::Point zero;
  EXPECT_EQ(rayRefusal(rays(Request::RAW, Request::FREE, Request::FREE)), "");
  EXPECT_NE(rayRefusal(Request()).find("layer = 0: must be INFLATED (1) or RAW (2)"),
            std::string::npos);
  EXPECT_NE(rayRefusal(rays(Request::RAW, 0, Request::FREE)).find("unknown = 0: must be OBSTACLE"),
            std::string::npos);
  EXPECT_NE(rayRefusal(rays(Request::RAW, Request::FREE, 7)).find("outside = 7: must be OBSTACLE"),
            std::string::npos);

  Request request = rays(Request::RAW, Request::FREE, Request::FREE);
  request.starts = {zero, zero};
  request.ends = {zero};
  EXPECT_NE(rayRefusal(request).find("starts has 2 points, ends has 1: must be as many"),
            std::string::npos);
  request.ends.push_back(toPoint({0.0, std::nan(""), 0.0}));
  EXPECT_NE(rayRefusal(request).find("segment 1: must be finite"), std::string::npos);
  request.ends[1] = toPoint({0.0, 1e7, 0.0});
  EXPECT_NE(rayRefusal(request).find("voxels along all segments must be at most 16777216"),
            std::string::npos);
  request.starts.resize((1 << 20) + 1);
  request.ends.resize((1 << 20) + 1, zero);
  EXPECT_NE(rayRefusal(request).find("segments must be at most 1048576"), std::string::npos);
}

}  // namespace
}  // namespace fiimap
