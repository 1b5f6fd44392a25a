#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/mapper.h"
#include "mapper_flight.h"
#include "mapper_model.h"
#include "oracle.h"

/// Whole histories of scans against the model, and against each other (invariants 1, 2, 3, 7).
namespace fiimap {
namespace {

using test::asScan;
using test::ElementDefinition;
using test::exactPoints;
using test::Flight;
using test::inSensorFrame;
using test::MapperModel;

constexpr ElementDefinition kElement{ElementShape::kBall, 500, 250};

MapperConfig randomConfig(test::Random& random) {
  MapperConfig config;
  config.resolution = kElement.resolution();
  config.map_size_x = test::uniformInt(random, 4, 20) * config.resolution;
  config.map_size_y = test::uniformInt(random, 4, 40) * config.resolution;
  config.map_size_z = test::uniformInt(random, 3, 70) * config.resolution;
  config.local_update_range_x = test::uniformInt(random, 4, 30) * config.resolution;
  config.local_update_range_y = test::uniformInt(random, 4, 30) * config.resolution;
  config.local_update_range_z = test::uniformInt(random, 4, 70) * config.resolution;
  const double max_slide = std::min(2.0, config.mapSize().minCoeff() / 2.0);
  config.slide_distance = test::uniformReal(random, 0.0, max_slide);
  config.ray_end_cut = test::uniformInt(random, 0, 3) * 0.5;
  config.round_rays = test::chance(random, 0.8);
  config.min_hit_cover = 0.0;  // of points, which the model takes, the density is not known
  config.max_ray_length = test::uniformReal(random, 2.0, 10.0);
  config.max_depth = 100.0;
  config.p_hit = test::uniformReal(random, 0.55, 0.9);
  config.p_miss = test::uniformReal(random, 0.3, 0.45);
  config.inflation_radius = kElement.radius();
  config.inflation_shape = kElement.shape;
  config.map_mode = test::chance(random, 0.2) ? MapMode::kFixed : MapMode::kSliding;
  const bool frees = test::chance(random, 0.7);
  config.beyond_max_depth = frees ? ReadingPolicy::kFree : ReadingPolicy::kIgnore;
  if (test::chance(random, 0.4)) config.decay_time = test::uniformInt(random, 1, 12) * Flight::kStampStep;
  return config;
}

/// A few boxes that lie in the window, or at least near it, and may overlap.
std::vector<VoxelBox> randomBoxes(test::Random& random, const VoxelBox& window) {
  const VoxelBox around{window.min.array() - 3, window.max.array() + 3};
  std::vector<VoxelBox> boxes;
  for (int i = test::uniformInt(random, 0, 4); i > 0; --i) {
    const VoxelIndex a = test::uniformVoxel(random, around), b = test::uniformVoxel(random, around);
    boxes.push_back({a.cwiseMin(b), a.cwiseMax(b)});
    const bool is_column = test::chance(random, 0.3), is_voxel = test::chance(random, 0.3);
    if (is_column || is_voxel) boxes.back().max.head<2>() = boxes.back().min.head<2>().array() + 1;
    if (is_voxel) boxes.back().max.z() = boxes.back().min.z() + 1;
  }
  return boxes;
}

class MapperModelTest : public ::testing::TestWithParam<int> {};

TEST_P(MapperModelTest, EveryVoxelIsAsTheModelSays) {
  test::Random random(GetParam());
  const MapperConfig config = randomConfig(random);
  Mapper mapper(config);
  MapperModel model(config);
  Flight flight(&random);
  std::size_t changes = 0;
  for (int scan = 0; scan < 40; ++scan) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", scan " + std::to_string(scan));
    if (test::chance(random, 0.03)) mapper.reset(), model.reset();
    const ScanPose pose = flight.next();
    const ScanReport slide = mapper.integrate(PointScan(), pose);
    const VoxelBox window = mapper.grid().window();
    model.integrate(pose, {}, window);
    ASSERT_EQ(slide.forgotten, model.forgotten());
    ASSERT_TRUE(model.decay(mapper.grid()));
    ASSERT_EQ(slide.raise, model.raised());

    const std::vector<Eigen::Vector3d> points_W = exactPoints(model, pose, window, flight.look());
    const ScanReport report = mapper.integrate(asScan(pose, points_W), pose);
    model.integrate(pose, points_W, window);
    ASSERT_EQ(mapper.grid().window(), window) << "the vehicle has not moved";
    ASSERT_TRUE(model.decay(mapper.grid()));
    ASSERT_TRUE(model.equals(mapper.grid(), kElement));
    ASSERT_EQ(report.lower, model.lowered());
    ASSERT_EQ(report.raise, model.raised());
    ASSERT_EQ(report.changeScore(), model.lowered() + model.raised());
    ASSERT_EQ(report.readings.total, points_W.size());
    changes += report.changeScore();

    if (!test::chance(random, 0.2)) continue;
    const auto state = static_cast<Occupancy>(test::uniformInt(random, 0, 2));
    const std::vector<VoxelBox> boxes = randomBoxes(random, window);
    ASSERT_EQ(mapper.overwrite(boxes, state), model.overwrite(boxes, state, window));
    ASSERT_TRUE(model.equals(mapper.grid(), kElement)) << "after an edit";
  }
  const bool is_roomy =
      std::min(config.mapSize().minCoeff(), config.localUpdateRange().minCoeff()) >= 2.0;
  if (config.map_mode == MapMode::kSliding && is_roomy) {
    EXPECT_GT(changes, 0u) << "the flight shows nothing";
  }
}

TEST_P(MapperModelTest, SameInputGivesTheSameMapInWhateverOrderThePointsCome) {
  test::Random random(1000 + GetParam());
  const MapperConfig config = randomConfig(random);
  Mapper mapper(config), same(config), shuffled(config);
  Flight flight(&random);
  for (int scan = 0; scan < 60; ++scan) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", scan " + std::to_string(scan));
    const ScanPose pose = flight.next();
    PointScan points = asScan(pose, flight.look());
    mapper.integrate(points, pose);
    same.integrate(points, pose);
    std::shuffle(points.points.begin(), points.points.end(), random);
    shuffled.integrate(points, pose);
    const auto expected = mapper.snapshot();
    for (Mapper* other : {&same, &shuffled}) {
      const auto actual = other->snapshot();
      ASSERT_EQ(actual->window(), expected->window());
      for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
        ASSERT_EQ(actual->voxels(plane, expected->window()),
                  expected->voxels(plane, expected->window()));
      }
    }
  }
}

TEST_P(MapperModelTest, ADepthImageIsTheCloudOfItsPoints) {
  test::Random random(2000 + GetParam());
  MapperConfig config = randomConfig(random);
  config.pixel_step = 1;
  config.border_margin = 0;
  config.min_depth = config.min_ray_length = 0.1;
  Mapper from_image(config), from_points(config);
  MapperModel model(config);
  Flight flight(&random);
  constexpr int kWidth = 12, kHeight = 9;
  constexpr PinholeIntrinsics kCamera{8.0, 9.0, 5.5, 4.25};
  for (int scan = 0; scan < 20; ++scan) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", scan " + std::to_string(scan));
    const ScanPose pose = flight.next();
    from_image.integrate(PointScan(), pose);
    from_points.integrate(PointScan(), pose);
    std::vector<float> pixels;
    std::vector<Eigen::Vector3d> points_C, points_W;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      pixels.push_back(static_cast<float>(test::uniformReal(random, 0.2, 12.0)));
      points_C.emplace_back((i % kWidth - kCamera.cx) / kCamera.fx * pixels[i],
                            (i / kWidth - kCamera.cy) / kCamera.fy * pixels[i], pixels[i]);
      points_W.push_back(pose.T_W_S * points_C[i]);
    }
    const std::vector<bool> is_exact = model.exactRays(pose, points_W, from_image.grid().window());
    PointScan points;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      if (is_exact[i]) {
        points.points.push_back(points_C[i].cast<float>());
      } else {
        pixels[i] = 0.0f;
      }
    }
    const DepthImage image{pixels.data(), DepthImage::Format::kFloat32, kWidth, kHeight,
                           kWidth * sizeof(float)};
    from_image.integrate(image, kCamera, pose);
    from_points.integrate(points, pose);
    const VoxelBox window = from_image.grid().window();
    ASSERT_EQ(from_points.grid().window(), window);
    for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
      ASSERT_EQ(from_image.snapshot()->voxels(plane, window),
                from_points.snapshot()->voxels(plane, window));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapperModelTest, ::testing::Range(1, 1 + test::effort(24)));

}  // namespace
}  // namespace fiimap
