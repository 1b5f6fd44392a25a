// Cross-validation: figures that can be worked out by hand, and the command on the sample flight.

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "accuracy_command.h"
#include "accuracy_report.h"
#include "held_out_split.h"
#include "json_file.h"
#include "scan_prediction.h"
#include "temporary_file.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.5;  // m; with points at quarters nothing is rounded

class ScanPredictionTest : public testing::Test {
 protected:
  ScanPredictionTest() : grid_({20, 20, 20}) {
    grid_.moveTo(VoxelIndex::Zero(), &changes_);
    scan_.origin = Eigen::Vector3d(0.25, 0.25, 0.25);
    scan_.returns.push_back({5.0f, 0.0f, 0.0f});  // ends at x = 5.25, in voxel 10
  }

  void setReturns(const std::vector<Eigen::Vector3f>& ends) {
    scan_.returns.clear();
    for (const Eigen::Vector3f& end : ends) scan_.returns.push_back(end);
  }

  ScanPrediction predictWith(const std::vector<VoxelIndex>& occupied) {
    grid_.clear();
    for (const VoxelIndex& v : occupied) grid_.set(Plane::kOccupied, v, true);
    Snapshot::Info info;
    info.resolution = kResolution;
    return predict(Snapshot(&grid_, info), scan_);
  }

  ChangeSet changes_;
  SlidingGrid grid_;
  RangeData scan_;
};

TEST_F(ScanPredictionTest, CountsTheVoxelOfTheEndPoint) {
  const ScanPrediction result = predictWith({{10, 0, 0}});
  EXPECT_EQ(result.rays, 1u);
  EXPECT_EQ(result.hits, 1u);
  EXPECT_EQ(result.near, 1u);
  EXPECT_EQ(result.blocked, 0u);
  EXPECT_EQ(result.outside, 0u);
}

TEST_F(ScanPredictionTest, FindsNothingInAnEmptyMap) {
  const ScanPrediction result = predictWith({});
  EXPECT_EQ(result.rays, 1u);
  EXPECT_EQ(result.hits + result.near + result.blocked, 0u);
}

TEST_F(ScanPredictionTest, CountsAllTwentySixNeighboursAsNear) {
  EXPECT_EQ(predictWith({{11, 1, 1}}).near, 1u);
  EXPECT_EQ(predictWith({{11, 1, 1}}).hits, 0u);
  EXPECT_EQ(predictWith({{12, 0, 0}}).near, 0u);
  EXPECT_EQ(predictWith({{10, 2, 0}}).near, 0u);
}

TEST_F(ScanPredictionTest, IsBlockedByWhatItLeavesMoreThanTwoVoxelsBeforeItsEnd) {
  EXPECT_EQ(predictWith({{7, 0, 0}}).blocked, 1u);  // left at x = 4.0: 2.5 voxels before the end
  EXPECT_EQ(predictWith({{8, 0, 0}}).blocked, 0u);  // left at x = 4.5: 1.5 voxels
  EXPECT_EQ(predictWith({{0, 0, 0}}).blocked, 1u);
  EXPECT_EQ(predictWith({{7, 1, 0}}).blocked, 0u);  // beside the ray
  setReturns({{4.75f, 0.0f, 0.0f}});                // ends at x = 5: exactly two voxels
  EXPECT_EQ(predictWith({{7, 0, 0}}).blocked, 0u);
}

TEST_F(ScanPredictionTest, CountsEndPointsOutsideOfTheWindow) {
  setReturns({{10.0f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f}});
  const ScanPrediction result = predictWith({{10, 0, 0}});
  EXPECT_EQ(result.rays, 2u);
  EXPECT_EQ(result.outside, 1u);
  EXPECT_EQ(result.hits, 1u);
  EXPECT_EQ(result.blocked, 1u);
}

TEST(HeldOutSplitTest, HoldsOutEveryTenth) {
  const HeldOutSplit split = HeldOutSplit::byFold(9, 10);
  EXPECT_TRUE(split.holdsOut(9));
  EXPECT_TRUE(split.holdsOut(599));
  EXPECT_FALSE(split.holdsOut(0));
  EXPECT_FALSE(split.holdsOut(10));
  EXPECT_THROW(HeldOutSplit::byFold(10, 10), std::invalid_argument);
  EXPECT_THROW(HeldOutSplit::byFold(-1, 10), std::invalid_argument);
  EXPECT_THROW(HeldOutSplit::byFold(0, 1), std::invalid_argument);
}

TEST(HeldOutSplitTest, HoldsOutEachScanInOneOfAllFolds) {
  const std::vector<HeldOutSplit> splits = HeldOutSplit::everyFold(4);
  ASSERT_EQ(splits.size(), 4u);
  for (std::size_t index = 0; index < 20; ++index) {
    int times = 0;
    for (const HeldOutSplit& split : splits) times += split.holdsOut(index) ? 1 : 0;
    EXPECT_EQ(times, 1) << index;
  }
  EXPECT_THROW(HeldOutSplit::everyFold(1), std::invalid_argument);
}

TEST(HeldOutSplitTest, ReadsAFile) {
  const TemporaryFile file("# index use\n0 build\n1 test  # held out\n\n3 test\n");
  const HeldOutSplit split = HeldOutSplit::fromFile(file.path());
  EXPECT_FALSE(split.holdsOut(0));
  EXPECT_TRUE(split.holdsOut(1));
  EXPECT_FALSE(split.holdsOut(2));
  EXPECT_TRUE(split.holdsOut(3));
  EXPECT_FALSE(split.holdsOut(4));
}

TEST(HeldOutSplitTest, RefusesOtherFiles) {
  for (const char* text : {"0 maybe\n", "x test\n", "-1 test\n", "7\n", "1 test 2\n"}) {
    const TemporaryFile file(text);
    EXPECT_THROW(HeldOutSplit::fromFile(file.path()), std::invalid_argument) << text;
  }
  EXPECT_THROW(HeldOutSplit::fromFile("/nowhere/split.txt"), std::invalid_argument);
}

TEST(AccuracyReportTest, GivesMeanAndDeviationOverScans) {
  // Shares of hits 1/2 and 1; the scan without rays does not count.
  const std::vector<ScanPrediction> scans = {{4, 2, 3, 1, 1}, {0, 0, 0, 0, 0}, {2, 2, 2, 1, 0}};
  const nlohmann::json json = toJson(summarise("fiimap", "final_map", 0.1, scans));
  EXPECT_EQ(json.at("method"), "fiimap");
  EXPECT_EQ(json.at("variant"), "final_map");
  EXPECT_EQ(json.at("resolution"), 0.1);
  EXPECT_EQ(json.at("held_out_scans"), 2);
  EXPECT_DOUBLE_EQ(json.at("hit_rate_mean"), 0.75);
  EXPECT_DOUBLE_EQ(json.at("hit_rate_std"), 0.25);
  EXPECT_DOUBLE_EQ(json.at("hit_rate_within_one_voxel_mean"), 0.875);
  EXPECT_DOUBLE_EQ(json.at("blocked_rate_mean"), 0.375);
  EXPECT_DOUBLE_EQ(json.at("outside_rate_mean"), 0.125);
}

TEST(AccuracyCommandTest, ForetellsTheSampleFlight) {
  const TemporaryFile json_file("");
  AccuracyOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  options.input.json = json_file.path();
  // The tool is tested, not the defaults.
  options.input.settings = {"p_hit=0.7", "p_miss=0.35", "ray_end_cut=1.5"};
  options.resolutions = {0.2, 0.4};
  ASSERT_EQ(evaluateAccuracy(options), 0);

  const nlohmann::json json = readJson(json_file.path());
  EXPECT_EQ(json.at("scans"), 110);
  EXPECT_EQ(json.at("held_out_step"), 4);
  EXPECT_EQ(json.at("split"), "index % 10 == 9");
  ASSERT_EQ(json.at("results").size(), 4u);
  for (const nlohmann::json& row : json.at("results")) {
    EXPECT_EQ(row.at("held_out_scans"), 11);
    EXPECT_GT(row.at("hit_rate_mean"), 0.8) << row;
    EXPECT_LT(row.at("hit_rate_mean"), 1.0) << row;
    EXPECT_GT(row.at("hit_rate_within_one_voxel_mean"), 0.95) << row;
    EXPECT_LT(row.at("blocked_rate_mean"), 0.5) << row;
    EXPECT_LT(row.at("outside_rate_mean"), 0.001) << row;  // the window is 6 m high
  }
  EXPECT_EQ(json.at("results")[0].at("variant"), "final_map");
  EXPECT_EQ(json.at("results")[1].at("variant"), "online");
  EXPECT_EQ(json.at("results")[1].at("resolution"), 0.2);
  EXPECT_EQ(json.at("results")[2].at("resolution"), 0.4);
  EXPECT_TRUE(json.at("parameters").contains("ray_end_cut"));
}

TEST(AccuracyCommandTest, HoldsOutEveryFoldInTurn) {
  const TemporaryFile json_file("");
  AccuracyOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  options.input.json = json_file.path();
  options.resolutions = {0.4};
  options.held_out_step = 8;
  options.folds = 2;
  ASSERT_EQ(evaluateAccuracy(options), 0);
  const nlohmann::json all = readJson(json_file.path());
  EXPECT_EQ(all.at("folds"), 2);
  EXPECT_EQ(all.at("results")[0].at("held_out_scans"), 110);

  // The mean over all scans is that of the folds, by their number of scans.
  double sum = 0.0;
  for (options.fold = 0; options.fold < 2; ++options.fold) {
    ASSERT_EQ(evaluateAccuracy(options), 0);
    const nlohmann::json row = readJson(json_file.path()).at("results")[0];
    sum += row.at("hit_rate_mean").get<double>() * row.at("held_out_scans").get<int>();
  }
  EXPECT_NEAR(all.at("results")[0].at("hit_rate_mean"), sum / 110, 1e-12);
}

// Where the rules are the same, two implementations that share nothing make nearly the same map.
// What remains: OctoMap moves points to the middle of their voxel, and so some of them beyond its
// range.
TEST(AccuracyCommandTest, AgreesWithOctomapWhereTheRulesDo) {
  const TemporaryFile json_file("");
  AccuracyOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/cow_and_lady_excerpt.bag";
  options.input.config = FIIMAP_SOURCE_DIR "/config/cow_and_lady.yaml";
  options.input.json = json_file.path();
  options.input.settings = {"ray_end_cut=0", "beyond_max_depth=ignore", "round_rays=false"};
  options.octomap = true;
  options.folds = 4;
  options.fold = 3;
  ASSERT_EQ(evaluateAccuracy(options), 0);
  const nlohmann::json json = readJson(json_file.path());
  ASSERT_EQ(json.at("results").size(), 4u);
  EXPECT_EQ(json.at("results")[0].at("method"), "fiimap");
  EXPECT_EQ(json.at("results")[2].at("method"), "octomap");
  for (const nlohmann::json& row : json.at("results")) {
    EXPECT_GT(row.at("hit_rate_within_one_voxel_mean"), 0.9) << row;
  }
  const nlohmann::json& agreement = json.at("octomap_agreement")[0];
  EXPECT_GT(agreement.at("free_overlap"), 0.97);
  EXPECT_GT(agreement.at("occupied_overlap"), 0.96);
  EXPECT_EQ(agreement.at("ours_found"), 1.0);
  EXPECT_EQ(agreement.at("theirs_found"), 1.0);
}

TEST(AccuracyCommandTest, RefusesWhatMakesNoSense) {
  AccuracyOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  options.held_out_step = 0;
  EXPECT_THROW(evaluateAccuracy(options), std::invalid_argument);
  options.held_out_step = 4;
  options.resolutions = {-1.0};
  EXPECT_THROW(evaluateAccuracy(options), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
