#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/mapper.h"
#include "fiimap/parameters.h"
#include "mapper_fixture.h"
#include "mapper_flight.h"
#include "mapper_model.h"
#include "oracle.h"

/// Configurations that change while the map is in use.
namespace fiimap {
namespace {

using test::ElementDefinition;
using test::poseAt;
using test::smallConfig;
using test::State;

constexpr int kResolutionMm = 250;

void setParameter(const std::string& name, const std::string& value, MapperConfig* config) {
  EXPECT_TRUE(applyParameters({{name, value}}, mapperParameters(config)).empty()) << name;
}

// What is in the map stays, by the new definition.

MapperConfig windowAtRandom(test::Random& random) {
  MapperConfig config;
  config.resolution = kResolutionMm / 1000.0;
  config.map_size_x = test::uniformInt(random, 8, 20) * config.resolution;
  config.map_size_y = test::uniformInt(random, 8, 40) * config.resolution;
  config.map_size_z = test::uniformInt(random, 3, 70) * config.resolution;
  config.min_hit_cover = 0.0;  // of points, which the model takes, the density is not known
  config.max_depth = 100.0;
  return config;
}

/// All that may change and that the model knows.
void tuneAtRandom(test::Random& random, const ElementDefinition& element, MapperConfig* config) {
  const auto range = [&] { return test::uniformInt(random, 4, 30) * config->resolution; };
  config->local_update_range_x = range();
  config->local_update_range_y = range();
  config->local_update_range_z = range();
  config->slide_distance = test::uniformReal(random, 0.0, config->mapSize().minCoeff() / 2.0);
  config->ray_end_cut = test::uniformInt(random, 0, 3) * 0.5;
  config->round_rays = test::chance(random, 0.5);
  config->min_ray_length = test::uniformReal(random, 0.0, 1.0);
  config->max_ray_length = test::uniformReal(random, 2.0, 10.0);
  const bool frees = test::chance(random, 0.7);
  config->beyond_max_depth = frees ? ReadingPolicy::kFree : ReadingPolicy::kIgnore;
  config->p_hit = test::uniformReal(random, 0.55, 0.97);
  config->p_miss = test::uniformReal(random, 0.1, 0.45);
  config->p_min = test::uniformReal(random, 0.01, config->p_miss - 0.01);
  config->p_max = test::uniformReal(random, 0.6, 0.99);
  config->p_occ = test::uniformReal(random, 0.51, config->p_max - 0.01);
  config->inflation_radius = element.radius();
  config->inflation_shape = element.shape;
  config->inflation_method = static_cast<InflationMethod>(test::uniformInt(random, 0, 2));
  config->decay_time = std::max(test::uniformInt(random, -10, 10), 0) * test::Flight::kStampStep;
}

ElementDefinition elementAtRandom(test::Random& random) {
  constexpr int kMostRadiusMm = 1000;
  return {static_cast<ElementShape>(test::uniformInt(random, 0, 2)),
          test::uniformInt(random, 0, kMostRadiusMm), kResolutionMm};
}

TEST(MapperReconfigureTest, EveryVoxelIsAsTheModelSaysWhateverChangesInFlight) {
  int flipped_without_scan = 0;
  for (int seed = 1; seed <= test::effort(20); ++seed) {
    test::Random random(seed);
    ElementDefinition element = elementAtRandom(random);
    MapperConfig config = windowAtRandom(random);
    tuneAtRandom(random, element, &config);
    Mapper mapper(config);
    test::MapperModel model(config);
    test::Flight flight(&random);
    for (int scan = 0; scan < 40; ++scan) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", scan " + std::to_string(scan));
      if (test::chance(random, 0.03)) mapper.reset(), model.reset();
      if (test::chance(random, 0.3)) {
        // All, or all but the inflation, or the inflation alone.
        if (test::chance(random, 0.7)) element = elementAtRandom(random);
        MapperConfig tuned = mapper.config();
        if (test::chance(random, 0.8)) tuneAtRandom(random, element, &tuned);
        tuned = test::withInflation(tuned, element.radius(), element.shape);
        const std::int64_t occupied = mapper.grid().count(Plane::kOccupied);
        mapper.reconfigure(tuned);
        model.reconfigure(tuned);
        ASSERT_TRUE(model.equals(mapper.grid(), element)) << "before the next scan";
        if (mapper.grid().count(Plane::kOccupied) != occupied) ++flipped_without_scan;
      }
      const ScanPose pose = flight.next();
      mapper.integrate(PointScan(), pose);
      const VoxelBox window = mapper.grid().window();
      model.integrate(pose, {}, window);
      ASSERT_TRUE(model.decay(mapper.grid()));
      const auto points_W = test::exactPoints(model, pose, window, flight.look());
      const ScanReport report = mapper.integrate(test::asScan(pose, points_W), pose);
      model.integrate(pose, points_W, window);
      ASSERT_TRUE(model.decay(mapper.grid()));
      ASSERT_TRUE(model.equals(mapper.grid(), element));
      ASSERT_EQ(report.lower, model.lowered());
      ASSERT_EQ(report.raise, model.raised());
    }
  }
  EXPECT_GT(flipped_without_scan, 0) << "no change of probabilities shows";
}

TEST(MapperReconfigureTest, APlannersSnapshotDoesNotChange) {
  Mapper mapper(smallConfig());
  test::seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  const auto before = mapper.snapshot();
  const auto occupied = before->voxels(Plane::kOccupied, before->window());
  const auto inflated = before->voxels(Plane::kInflated, before->window());
  MapperConfig config = test::withInflation(smallConfig(), 0.75, ElementShape::kCube);
  config.p_occ = 0.9;  // of 3 hits, no more
  mapper.reconfigure(config);
  EXPECT_EQ(mapper.grid().count(Plane::kOccupied), 0);
  EXPECT_EQ(before->voxels(Plane::kOccupied, before->window()), occupied);
  EXPECT_EQ(before->voxels(Plane::kInflated, before->window()), inflated);
  EXPECT_EQ(before->info().inflation_radius, 0.5);
}

TEST(MapperReconfigureTest, TheThresholdAloneChangesNoLogOdds) {
  MapperConfig config = smallConfig();
  Mapper mapper(config);
  test::seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  mapper.integrate(PointScan(), poseAt({0.1, 0.1, 0.1}));
  const State before(&mapper);
  ASSERT_EQ(before.occupied.size(), 1u);
  for (const double p_occ : {0.9, 0.55, 0.95, 0.6, 0.8}) {
    config.p_occ = p_occ;
    mapper.reconfigure(config);
    EXPECT_EQ(mapper.grid().count(Plane::kOccupied), p_occ < 0.87 ? 1 : 0) << p_occ;
  }
  EXPECT_TRUE(State(&mapper) == before);
}

// Scans are integrated as by a mapper that was made with the new configuration.

/// What a planner could see and ask of a map.
struct View : State {
  std::vector<Occupancy> answers;

  explicit View(Mapper* mapper) : State(mapper) {
    const auto snapshot = mapper->snapshot();
    test::forEachVoxel(window,
                       [&](const VoxelIndex& v) { answers.push_back(snapshot->occupancy(v)); });
  }
  bool operator==(const View& o) const { return State::operator==(o) && answers == o.answers; }
};

constexpr int kWidth = 32, kHeight = 24;
constexpr PinholeIntrinsics kCamera{20.0, 20.0, 16.0, 12.0};

/// A wall in front of a camera that looks along x, with readings of every kind in it.
std::vector<float> wallAt(float depth) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  std::vector<float> pixels(kWidth * kHeight, depth);
  for (int v = 0; v < kHeight; ++v) {
    float* const row = pixels.data() + v * kWidth;
    row[0] = row[kWidth - 1] = 0.7f * depth;  // in the border
    for (int u = 4; u < 8; ++u) row[u] = 0.0f;
    for (int u = 10; u < 14; ++u) row[u] = kInf;
    for (int u = 16; u < 19; ++u) row[u] = 1.2f * depth;
    row[20] = 0.5f * depth;  // a sliver
    if (v % 2 == 1) row[22] = 0.6f * depth;
  }
  return pixels;
}

/// A short flight towards a wall that comes nearer and goes away again, in images of both formats;
/// what is seen after each scan.
std::vector<View> fly(Mapper* mapper) {
  std::vector<View> views;
  for (int scan = 0; scan < 16; ++scan) {
    ScanPose pose = poseAt({0.1 * scan, 0.05, 0.1}, scan + 1);
    pose.T_W_S.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // z ahead, x to the right, y down
    const std::vector<float> depths = wallAt(scan < 4 || scan > 11 ? 2.9f : 1.9f);
    std::vector<std::uint16_t> millimetres;
    for (const float depth : depths) {
      millimetres.push_back(std::isfinite(depth) ? static_cast<std::uint16_t>(1000.0f * depth) : 0);
    }
    mapper->integrate({depths.data(), DepthImage::Format::kFloat32, kWidth, kHeight, 4 * kWidth},
                      kCamera, pose);
    views.emplace_back(mapper);
    if (scan % 4 != 0) continue;
    mapper->integrate(
        {millimetres.data(), DepthImage::Format::kUint16, kWidth, kHeight, 2 * kWidth}, kCamera,
        pose);
    views.emplace_back(mapper);
  }
  return views;
}

/// Another value for each parameter that may change.
const std::map<std::string, std::string>& otherValues() {
  static const std::map<std::string, std::string> values = {
      {"slide_distance", "0.25"},
      {"local_update_range_x", "2"},
      {"local_update_range_y", "1"},
      {"local_update_range_z", "1"},
      {"depth_scale", "0.0007"},
      {"min_depth", "1.5"},
      {"max_depth", "2"},
      {"pixel_step", "3"},
      {"border_margin", "0"},
      {"invalid_depth", "free"},
      {"infinite_depth", "ignore"},
      {"beyond_max_depth", "ignore"},
      {"min_ray_length", "2"},
      {"max_ray_length", "2"},
      {"ray_end_cut", "2"},
      {"min_hit_cover", "0.9"},
      {"round_rays", "false"},
      {"body_size_x", "1"},
      {"body_size_y", "2"},
      {"body_size_z", "2"},
      {"clear_body", "true"},
      {"decay_time", "2e-9"},
      {"p_hit", "0.55"},
      {"p_miss", "0.45"},
      {"p_min", "0.25"},
      {"p_max", "0.85"},
      {"p_occ", "0.6"},
      {"inflation_radius", "0.75"},
      {"inflation_shape", "cube"},
      {"inflation_method", "bfs"},
      {"bfs_connectivity", "26"},
      {"virtual_walls", "false"},
      {"virtual_floor", "0.2"},
      {"virtual_ceiling", "0.5"},
  };
  return values;
}

MapperConfig flownConfig() {
  MapperConfig config = smallConfig();
  config.max_depth = config.max_ray_length = 3.0;
  config.pixel_step = 1;
  config.body_size_x = 4.2;  // to behind the wall where it is near
  config.body_size_y = config.body_size_z = 0.6;
  config.virtual_walls = true;
  config.virtual_floor = -0.6;
  config.virtual_ceiling = 0.9;
  return config;
}

TEST(MapperReconfigureTest, EachParameterHoldsFromThenOn) {
  Mapper untuned(flownConfig());
  const std::vector<View> without = fly(&untuned);
  std::size_t tried = 0;
  MapperConfig listed;
  for (const Parameter& parameter : mapperParameters(&listed)) {
    if (!parameter.tunable) continue;
    SCOPED_TRACE(parameter.name);
    ++tried;
    ASSERT_EQ(otherValues().count(parameter.name), 1u);
    MapperConfig config = flownConfig();
    setParameter(parameter.name, otherValues().at(parameter.name), &config);
    Mapper made(config), tuned(flownConfig());
    const std::vector<View> expected = fly(&made);
    fly(&tuned);
    tuned.reset();
    tuned.reconfigure(config);
    const std::vector<View> views = fly(&tuned);
    EXPECT_TRUE(views == expected) << "is not integrated as if it had always been so";
    const bool has_no_effect =
        parameter.name == "inflation_method" || parameter.name == "bfs_connectivity";
    EXPECT_EQ(views == without, has_no_effect);
  }
  EXPECT_EQ(tried, otherValues().size());
}

TEST(MapperReconfigureTest, EachOfSeveralSensorsHoldsItsOwn) {
  MapperConfig config = smallConfig();
  config.sensors.assign(2, config);
  Mapper mapper(config);
  const PointScan scan = {{{2.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
  const ScanPose pose = poseAt({0.1, 0.1, 0.1});
  mapper.integrate(scan, pose, 0);
  config.sensors[1].max_ray_length = 1.5;
  mapper.reconfigure(config);
  EXPECT_EQ(mapper.integrate(scan, pose, 0).readings.too_far, 0u);
  EXPECT_EQ(mapper.integrate(scan, pose, 1).readings.too_far, 1u);
}

// What cannot change is refused.

void expectRefused(const MapperConfig& config, const std::string& words) {
  Mapper mapper(smallConfig());
  test::seeAnObstacle(&mapper, {0.1, 0.1, 0.1});
  const State before(&mapper);
  try {
    mapper.reconfigure(config);
    ADD_FAILURE() << "accepted, expected: " << words;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
  EXPECT_TRUE(State(&mapper) == before);
  MapperConfig old = smallConfig(), now = mapper.config();
  const auto olds = mapperParameters(&old), nows = mapperParameters(&now);
  for (std::size_t i = 0; i < olds.size(); ++i) EXPECT_EQ(nows[i].get(), olds[i].get());
}

TEST(MapperReconfigureTest, RefusesWhatIsFixedWithTheMapUnchanged) {
  const std::map<std::string, std::string> others = {
      {"resolution", "0.2"}, {"map_mode", "fixed"}, {"map_size_x", "9"},
      {"map_size_y", "9"},   {"map_size_z", "9"},   {"map_center_x", "1"},
      {"map_center_y", "1"}, {"map_center_z", "1"}, {"memory_limit", "9000"}};
  std::size_t tried = 0;
  MapperConfig listed = smallConfig();
  for (const Parameter& parameter : mapperParameters(&listed)) {
    if (parameter.tunable) continue;
    ++tried;
    MapperConfig config = smallConfig();
    config.p_occ = 0.6;  // which may change, but not with it
    setParameter(parameter.name, others.at(parameter.name), &config);
    expectRefused(config, "parameter " + parameter.name + " = '" + others.at(parameter.name) +
                              "': must stay '" + parameter.get() + "' while the map is in use");
  }
  EXPECT_EQ(tried, others.size());
  MapperConfig config = smallConfig();
  config.sensors.assign(2, config);
  expectRefused(config, "parameter sensors = '2': must stay '1'");
}

TEST(MapperReconfigureTest, RefusesWhatIsNotValidWithTheMapUnchanged) {
  MapperConfig config = smallConfig();
  config.p_occ = 0.98;
  expectRefused(config, "parameter p_occ = 0.98");
  config = smallConfig();
  config.slide_distance = 2.0;
  expectRefused(config, "parameter slide_distance = 2.0");
  config = smallConfig();
  config.pixel_step = -1;
  expectRefused(config, "parameter pixel_step = '-1'");
}

}  // namespace
}  // namespace fiimap
