#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/mapper.h"
#include "mapper_fixture.h"
#include "mapper_model.h"
#include "oracle.h"

/// The map at the ends of what numbers allow, against the model.
namespace fiimap {
namespace {

using test::ElementDefinition;
using test::MapperModel;

/// Where, and with which sizes.
struct Edge {
  std::string name;
  int resolution_mm;
  VoxelIndex window;       // voxels
  int radius_mm;           // of inflation
  Eigen::Vector3d origin;  // m, about which the vehicle moves
};

constexpr double kLastIndex = (1 << 30) - 1;  // of voxels that can be indexed

std::vector<Edge> edges() {
  const VoxelIndex usual(12, 14, 10);
  return {
      {"FarFromTheOrigin", 100, usual, 200, {1e6, -1e6, 1e6}},
      {"FineAndFarFromTheOrigin", 10, usual, 20, {1e6, -1e6, 1e6}},
      {"AtTheLastIndices", 250, usual, 500, Eigen::Vector3d::Constant((kLastIndex - 8.0) * 0.25)},
      {"AtTheFirstIndices", 250, usual, 500, Eigen::Vector3d::Constant((8.0 - kLastIndex) * 0.25)},
      {"TinyVoxels", 10, usual, 20, {0.0, 0.0, 0.0}},
      {"HugeVoxels", 10000, usual, 20000, {0.0, 0.0, 0.0}},
      {"HugeVoxelsAtTheLastIndices", 10000, usual, 10000,
       Eigen::Vector3d::Constant((kLastIndex - 8.0) * 10.0)},
      {"OneVoxel", 250, {1, 1, 1}, 0, {0.0, 0.0, 0.0}},
      {"OneVoxelAndALargeRadius", 250, {1, 1, 1}, 2000, {5.0, -3.0, 2.0}},
      {"OneColumn", 250, {1, 1, 70}, 1000, {0.0, 0.0, 0.0}},
      {"OneLayer", 250, {20, 20, 1}, 1000, {0.0, 0.0, 0.0}},
      {"RadiusBeyondTheWindow", 250, {6, 5, 4}, 3000, {-7.0, 0.0, 7.0}},
      {"LargestRadius", 250, {3, 4, 5}, 64 * 250, {0.0, 0.0, 0.0}},
  };
}

MapperConfig configOf(const Edge& edge, const ElementDefinition& element) {
  MapperConfig config;
  config.resolution = element.resolution();
  config.map_size_x = edge.window.x() * config.resolution;
  config.map_size_y = edge.window.y() * config.resolution;
  config.map_size_z = edge.window.z() * config.resolution;
  config.local_update_range_x = config.local_update_range_y = config.local_update_range_z =
      24 * config.resolution;
  config.slide_distance = config.mapSize().minCoeff() / 2.0;
  config.min_ray_length = 0.5 * config.resolution;
  config.max_ray_length = 9.0 * config.resolution;
  config.ray_end_cut = 0.5;
  config.inflation_radius = element.radius();
  config.inflation_shape = element.shape;
  return config;
}

class EdgeNumbersTest : public ::testing::TestWithParam<Edge> {
 protected:
  Eigen::Vector3d within(double reach) {
    return Eigen::Vector3d::NullaryExpr(
        [&](Eigen::Index) { return test::uniformReal(random_, -reach, reach); });
  }

  test::Random random_{7};
};

TEST_P(EdgeNumbersTest, EveryVoxelIsAsTheModelSays) {
  const Edge& edge = GetParam();
  for (const ElementShape shape :
       {ElementShape::kBall, ElementShape::kCube, ElementShape::kDiamond}) {
    const ElementDefinition element{shape, edge.radius_mm, edge.resolution_mm};
    const MapperConfig config = configOf(edge, element);
    const double edge_m = config.resolution;
    Mapper mapper(config);
    MapperModel model(config);
    const Eigen::Vector3d obstacle = edge.origin + within(1.0 * edge_m);
    std::int64_t seen = 0;
    for (int scan = 0; scan < 3 * test::effort(10); ++scan) {
      SCOPED_TRACE(test::nameOf(shape) + ", scan " + std::to_string(scan));
      const ScanPose pose = test::poseAt(edge.origin + within(1.5 * edge_m));
      mapper.integrate(PointScan(), pose);
      const VoxelBox window = mapper.grid().window();
      model.integrate(pose, {}, window);
      std::vector<Eigen::Vector3f> offsets;
      std::vector<Eigen::Vector3d> all_W;
      for (int i = 0; i < 12; ++i) {
        const Eigen::Vector3d point_W =
            i % 3 == 0 ? edge.origin + within(7.0 * edge_m) : obstacle + within(0.2 * edge_m);
        offsets.push_back((point_W - pose.vehicle_W).cast<float>());
        all_W.push_back(pose.vehicle_W + offsets.back().cast<double>());
      }
      PointScan points;
      std::vector<Eigen::Vector3d> points_W;
      const std::vector<bool> is_exact = model.exactRays(pose, all_W, window);
      for (std::size_t i = 0; i < all_W.size(); ++i) {
        if (!is_exact[i]) continue;
        points.points.push_back(offsets[i]);
        points_W.push_back(all_W[i]);
      }
      mapper.integrate(points, pose);
      model.integrate(pose, points_W, window);
      ASSERT_TRUE(model.equals(mapper.grid(), element));
      seen += mapper.grid().count(Plane::kKnown);
    }
    EXPECT_GT(seen, 0) << "nothing was seen";
  }
}

INSTANTIATE_TEST_SUITE_P(Edges, EdgeNumbersTest, ::testing::ValuesIn(edges()),
                         [](const auto& info) { return info.param.name; });

TEST(IndexLimitTest, TheVehicleGoesFromTheFirstVoxelToTheLastAndNotBeyond) {
  MapperConfig config = test::smallConfig();
  Mapper mapper(config);
  const double last = kLastIndex * config.resolution;  // lowest face of the last voxel
  for (const double at : {last, -last, last, 0.0}) {
    const Eigen::Vector3d position = Eigen::Vector3d::Constant(at);
    mapper.integrate(PointScan{{{1.0f, 0.0f, 0.0f}}}, test::poseAt(position));
    EXPECT_TRUE(mapper.grid().window().contains(VoxelLattice(config.resolution).indexOf(position)));
    EXPECT_GT(mapper.grid().count(Plane::kKnown), 0) << at;
  }
  for (const double beyond : {last + config.resolution, -last - config.resolution}) {
    EXPECT_THROW(mapper.integrate(PointScan(), test::poseAt(Eigen::Vector3d::Constant(beyond))),
                 std::invalid_argument);
  }
}

TEST(IndexLimitTest, AFixedWindowAtTheLargestCenterIsSeenFromTheOtherEndOfTheWorld) {
  MapperConfig config = test::smallConfig();
  config.resolution = 0.01;
  config.inflation_radius = 0.05;
  config.map_mode = MapMode::kFixed;
  config.map_center_x = config.map_center_y = config.map_center_z = 1e7;
  Mapper mapper(config);
  for (const double at : {-1e7, 0.0, 1e7}) {
    const auto pose = test::poseAt(Eigen::Vector3d::Constant(at));
    const RayCount rays = mapper.integrate(PointScan{{{1.0f, 0.0f, 0.0f}}}, pose).rays;
    EXPECT_EQ(rays.hits, at > 0.0 ? 1u : 0u) << at;
  }
}

/// Rays through pixels that numbers cannot express say nothing, least of all in the corner of the
/// update range.
TEST(ExtremeIntrinsicsTest, RaysThatAreNoNumbersAreInvalidReadings) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float pixels[4] = {1.0f, 100.0f, kInf, 2.0f};
  const DepthImage image{pixels, DepthImage::Format::kFloat32, 2, 2, 2 * sizeof(float)};
  for (const PinholeIntrinsics& camera :
       {PinholeIntrinsics{1e-300, 1e-300, 0.5, 0.5}, PinholeIntrinsics{1.0, 1.0, 1e300, 0.5},
        PinholeIntrinsics{1.0, 1.0, 0.5, -1e300}, PinholeIntrinsics{1e-30, 1.0, 0.5, 0.5}}) {
    MapperConfig config = test::smallConfig();
    config.pixel_step = 1;
    config.border_margin = 0;
    config.invalid_depth = ReadingPolicy::kFree;
    Mapper mapper(config);
    const ScanReport report = mapper.integrate(image, camera, test::poseAt({0.1, 0.1, 0.1}));
    EXPECT_EQ(report.readings.invalid, 4u) << camera.fx << " " << camera.cx << " " << camera.cy;
    EXPECT_EQ(report.readings.total, 4u);
    EXPECT_EQ(mapper.grid().count(Plane::kKnown), 0);
  }
}

}  // namespace
}  // namespace fiimap
