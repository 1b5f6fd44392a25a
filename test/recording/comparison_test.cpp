// Inflation timed by resolution, radius and method; methods timed update by update. Times are not
// looked at, only that each method did the work.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "baselines/inflation_replay.h"
#include "compare_command.h"
#include "compare_report.h"
#include "json_file.h"
#include "quantiles.h"
#include "sweep_command.h"
#include "temporary_file.h"

namespace fiimap {
namespace {

constexpr char kCow[] = FIIMAP_SOURCE_DIR "/data/cow_and_lady_excerpt.bag";  // 4 clouds
constexpr char kCowConfig[] = FIIMAP_SOURCE_DIR "/config/cow_and_lady.yaml";

template <typename Options>
Options cowOptions(const std::string& json_file) {
  Options options;
  options.input.bag = kCow;
  options.input.config = kCowConfig;
  options.input.settings = {"p_hit=0.9"};  // the first cloud occupies voxels already
  options.input.json = json_file;
  return options;
}

TEST(QuantilesTest, AreNearestRanks) {
  const Quantiles q = quantilesOf({5.0, 1.0, 2.0, 4.0, 3.0});
  EXPECT_EQ(q.median, 3.0);
  EXPECT_EQ(q.p95, 5.0);
  EXPECT_EQ(q.max, 5.0);
  EXPECT_EQ(quantilesOf({1.0, 2.0}).median, 1.0);
  EXPECT_EQ(quantilesOf({}).max, 0.0);
}

/// A wall of one cloud, then nothing of it any more.
std::vector<bench::InflationStep> stepsOfAWall() {
  bench::InflationStep step;
  step.window = {{-20, -20, -10}, {20, 20, 10}};
  step.update_box = {{-12, -12, -8}, {12, 12, 8}};
  for (int y = -3; y <= 3; ++y) step.lower.emplace_back(5, y, 0);
  bench::InflationStep back = step;
  back.raise.assign(step.lower.begin(), step.lower.begin() + 5);
  back.lower.clear();
  return {step, back};
}

TEST(InflationReplayTest, EveryMethodMakesTheSameLayer) {
  MapperConfig config;
  config.resolution = 0.5;
  config.map_size_x = config.map_size_y = 20.0;
  config.map_size_z = 10.0;
  config.inflation_radius = 1.0;
  const std::vector<bench::InflationStep> steps = stepsOfAWall();
  std::set<std::int64_t> inflated;
  for (const char* name : bench::kInflations) {
    const auto replay = bench::makeReplay(name, config, steps.front().update_box);
    for (const bench::InflationStep& step : steps) {
      replay->prepare(step);
      replay->update();
    }
    std::int64_t count = 0;
    for (int x = -12; x < 12; ++x) {
      for (int y = -12; y < 12; ++y) {
        for (int z = -8; z < 8; ++z) count += replay->isInflated({x, y, z}) ? 1 : 0;
      }
    }
    inflated.insert(count);
  }
  // Two voxels in a row, inflated by the 33 offsets of a ball of radius 2.
  EXPECT_EQ(inflated, std::set<std::int64_t>({46}));
}

TEST(SweepCommandTest, MeasuresEverySettingOnTheSameUpdates) {
  const TemporaryFile json_file("");
  auto options = cowOptions<SweepOptions>(json_file.path());
  options.resolutions = {0.4, 0.2};
  options.reaches = {1, 3};
  options.shapes = {"ball", "cube"};
  ASSERT_EQ(sweepInflation(options), 0);
  const nlohmann::json json = readJson(json_file.path());
  EXPECT_EQ(json.at("integrated"), 4);
  ASSERT_EQ(json.at("results").size(), 2u * 2u * 2u * 6u);
  std::set<std::string> settings;
  for (nlohmann::json row : json.at("results")) {
    EXPECT_EQ(row.at("updates"), 4) << row;
    EXPECT_GT(row.at("max_us"), 0.0) << row;
    EXPECT_LE(row.at("median_us"), row.at("p95_us")) << row;
    settings.insert(row.at("resolution").dump() + row.at("shape").dump() + row.at("reach").dump() +
                    row.at("method").dump());
  }
  EXPECT_EQ(settings.size(), 48u);
  ASSERT_EQ(json.at("change_score").size(), 2u);
  EXPECT_GT(json.at("change_score")[0].at("max"), 0.0);
}

TEST(SweepCommandTest, RefusesWhatMakesNoSense) {
  const auto refuses = [](auto change) {
    SweepOptions options;
    options.input.bag = kCow;
    change(&options);
    EXPECT_THROW(sweepInflation(options), std::invalid_argument);
  };
  refuses([](SweepOptions* options) { options->shapes = {"pyramid"}; });
  refuses([](SweepOptions* options) { options->methods = {"magic"}; });
  refuses([](SweepOptions* options) { options->reaches = {0}; });
  refuses([](SweepOptions* options) { options->seconds = 0.0; });
  refuses([](SweepOptions* options) { options->resolutions = {0.0}; });
}

TEST(CompareCommandTest, MeasuresEveryUpdateWithEveryMethod) {
  const TemporaryFile json_file("");
  auto options = cowOptions<CompareOptions>(json_file.path());
  options.methods = {"incremental", "bfs6", "byte_batch", "fiimap", "ego", "per_pixel", "octomap"};
  options.csv = true;
  testing::internal::CaptureStdout();
  ASSERT_EQ(compareMethods(options), 0);
  std::istringstream csv(testing::internal::GetCapturedStdout());

  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line,
            "update,stamp,change_score,incremental_us,bfs6_us,byte_batch_us,fiimap_us,ego_us,"
            "per_pixel_us,octomap_us");
  int rows = 0;
  while (std::getline(csv, line)) ++rows;
  EXPECT_EQ(rows, 4);

  const nlohmann::json json = readJson(json_file.path());
  EXPECT_EQ(json.at("updates"), 4);
  ASSERT_EQ(json.at("methods").size(), 7u);
  EXPECT_EQ(json.at("methods")[2].at("method"), "byte_batch");
  EXPECT_EQ(json.at("methods")[2].at("what"), "inflation");
  EXPECT_EQ(json.at("methods")[4].at("what"), "map");
  int updates = 0;
  for (const nlohmann::json& bin : json.at("by_change_score")) {
    updates += bin.at("updates").get<int>();
    EXPECT_EQ(bin.at("median_us").size(), 7u);
  }
  EXPECT_EQ(updates, 4);
  EXPECT_GT(json.at("octomap_agreement").at("occupied_overlap"), 0.8);
}

TEST(CompareCommandTest, RefusesUnknownMethodsAndArraysWithoutEnd) {
  CompareOptions options;
  options.input.bag = kCow;
  options.methods = {"magic"};
  EXPECT_THROW(compareMethods(options), std::invalid_argument);
  const VoxelBox endless = {VoxelIndex::Zero(), VoxelIndex::Constant(10000)};
  EXPECT_THROW(bench::makeReplay("byte_batch", {}, endless), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
