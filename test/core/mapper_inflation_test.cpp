#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/mapper.h"
#include "inflation_fixture.h"
#include "oracle.h"

/// All methods of inflation over the same history of scans: exact, and the same.
namespace fiimap {
namespace {

using test::ElementDefinition;

constexpr ElementShape kShapes[] = {ElementShape::kBall, ElementShape::kCube,
                                    ElementShape::kDiamond};

/// One mapper for each method, fed with the same scans.
class Mappers {
 public:
  Mappers(const ElementDefinition& element, const VoxelIndex& size) : element_(element) {
    for (const test::Method& method : test::kMethods) {
      MapperConfig config = configFor(method, element, size);
      config.slide_distance = config.resolution;
      config.local_update_range_x = config.map_size_x;
      config.local_update_range_y = config.map_size_y;
      config.local_update_range_z = config.map_size_z;
      config.min_ray_length = 0.0;
      config.p_hit = 0.9;  // one hit occupies, two misses free
      config.p_miss = 0.25;
      config.p_max = 0.92;
      mappers_.push_back(std::make_unique<Mapper>(config));
    }
  }

  void integrate(const PointScan& points, const ScanPose& pose) {
    for (const auto& mapper : mappers_) mapper->integrate(points, pose);
  }
  void reset() {
    for (const auto& mapper : mappers_) mapper->reset();
  }
  void overwrite(const VoxelBox& box, Occupancy state) {
    for (const auto& mapper : mappers_) mapper->overwrite({box}, state);
  }
  VoxelBox window() const { return mappers_.front()->grid().window(); }
  void setElement(const ElementDefinition& element) {
    element_ = element;
    for (const auto& mapper : mappers_) {
      MapperConfig config = mapper->config();
      config.inflation_radius = element.radius();
      config.inflation_shape = element.shape;
      mapper->reconfigure(config);
    }
  }

  void check() const {
    const SlidingGrid& first = mappers_.front()->grid();
    test::VoxelSet occupied;
    first.forEach(Plane::kOccupied, first.window(),
                  [&](const VoxelIndex& v) { occupied.insert(v); });
    const test::VoxelField expected = dilate(occupied, element_.offsets(), first.window());
    for (std::size_t i = 0; i < mappers_.size(); ++i) {
      ASSERT_TRUE(planeEquals(mappers_[i]->grid(), Plane::kInflated, expected))
          << nameOf(test::kMethods[i]);
    }
  }

  std::int64_t occupied() const { return mappers_.front()->grid().count(Plane::kOccupied); }

 private:
  ElementDefinition element_;
  std::vector<std::unique_ptr<Mapper>> mappers_;
};

PointScan randomPoints(test::Random& random, int count) {
  PointScan scan;
  for (int i = 0; i < count; ++i) {
    scan.points.push_back(Eigen::Vector3f::NullaryExpr(
        [&](Eigen::Index) { return static_cast<float>(test::uniformReal(random, -1.2, 1.2)); }));
  }
  return scan;
}

class MapperInflationTest : public ::testing::TestWithParam<ElementShape> {};

TEST_P(MapperInflationTest, AllMethodsAgreeWithTheDefinitionOverAFlight) {
  constexpr int kRadiiMm[] = {0, 100, 150, 200, 300, 420};
  std::int64_t most_occupied = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    test::Random random(seed);
    const VoxelIndex size = test::uniformVoxel(random, {{3, 3, 3}, {25, 40, 25}});
    Mappers mappers({GetParam(), 200, 100}, size);
    ScanPose pose;
    for (int scan = 0; scan < 30; ++scan) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", scan " + std::to_string(scan));
      if (test::chance(random, 0.05)) mappers.reset();
      if (test::chance(random, 0.1)) {
        mappers.setElement({kShapes[test::uniformInt(random, 0, 2)],
                            kRadiiMm[test::uniformInt(random, 0, 5)], 100});
        ASSERT_NO_FATAL_FAILURE(mappers.check());
      }
      const double reach = test::chance(random, 0.05) ? 100.0 : 0.3;
      for (int axis = 0; axis < 3; ++axis) {
        pose.vehicle_W[axis] += test::uniformReal(random, -reach, reach);
      }
      pose.T_W_S.translation() = pose.vehicle_W;
      mappers.integrate(randomPoints(random, test::uniformInt(random, 0, 6)), pose);
      ASSERT_NO_FATAL_FAILURE(mappers.check());
      if (test::chance(random, 0.2)) {
        const VoxelIndex a = test::voxelNearFaces(random, mappers.window());
        const VoxelIndex b = a.array() + test::uniformInt(random, 1, 4);
        mappers.overwrite({a, b}, static_cast<Occupancy>(test::uniformInt(random, 0, 2)));
        ASSERT_NO_FATAL_FAILURE(mappers.check());
      }
      most_occupied = std::max(most_occupied, mappers.occupied());
    }
  }
  EXPECT_GT(most_occupied, 10) << "the flight shows nothing";
}

INSTANTIATE_TEST_SUITE_P(Shapes, MapperInflationTest, ::testing::ValuesIn(kShapes),
                         [](const auto& info) { return test::nameOf(info.param); });

}  // namespace
}  // namespace fiimap
