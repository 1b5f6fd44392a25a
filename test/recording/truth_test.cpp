// The exact scene and the figures that compare a map with it, on cases worked out by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "exact_scene.h"
#include "seen_surface.h"
#include "temporary_file.h"
#include "truth_command.h"
#include "truth_report.h"

namespace fiimap {
namespace {

constexpr double kTolerance = 1e-9;
const Eigen::Vector3d kForward = Eigen::Vector3d::UnitX();

/// A wall whose near face is at x = 4, and a ball that stands at (2, 3, 1) from t = 1 s to 2 s.
constexpr char kWallAndBall[] = R"({"t0": 0.0, "primitives": [
  {"type": "box", "center": [4.5, 0, 1], "size": [1, 20, 20]},
  {"type": "sphere", "center": [2, 3, 1], "radius": 0.5, "t_on": 1.0, "t_off": 2.0}]})";

ExactScene sceneFrom(const std::string& json) {
  const TemporaryFile file(json);
  return ExactScene::load(file.path());
}

ExactScene sceneOf(const std::string& primitive) {
  return sceneFrom(R"({"t0": 0.0, "primitives": [)" + primitive + "]}");
}

double alongX(const ExactScene& scene, double y, double z) {
  return scene.firstHit({0.0, y, z}, kForward, 0.0).distance;
}

TEST(ExactSceneRayTest, EntersABox) {
  const ExactScene scene = sceneOf(
      R"({"type": "box", "center": [5, 0, 0], "size": [2, 4, 6], "yaw": 1.5707963267948966})");
  EXPECT_NEAR(alongX(scene, 0.9, 2.9), 3.0, kTolerance);  // turned: 4 m along x
  EXPECT_TRUE(std::isinf(alongX(scene, 1.1, 0.0)));
  EXPECT_TRUE(std::isinf(alongX(scene, 0.0, 3.1)));
  EXPECT_TRUE(std::isinf(scene.firstHit({9.0, 0.0, 0.0}, kForward, 0.0).distance));
}

TEST(ExactSceneRayTest, EntersASphere) {
  const ExactScene scene = sceneOf(R"({"type": "sphere", "center": [5, 0, 0], "radius": 1})");
  EXPECT_NEAR(alongX(scene, 0.0, 0.0), 4.0, kTolerance);
  EXPECT_NEAR(alongX(scene, 0.6, 0.0), 4.2, kTolerance);
  EXPECT_TRUE(std::isinf(alongX(scene, 1.1, 0.0)));
}

TEST(ExactSceneRayTest, EntersACylinderThroughItsSideOrACap) {
  const ExactScene upright =
      sceneOf(R"({"type": "cylinder", "center": [5, 0, 0], "radius": 1, "length": 2})");
  EXPECT_NEAR(alongX(upright, 0.6, 0.9), 4.2, kTolerance);
  EXPECT_TRUE(std::isinf(alongX(upright, 0.0, 1.1)));
  const Eigen::Vector3d down(0.0, 0.0, -1.0);
  EXPECT_NEAR(upright.firstHit({5.5, 0.0, 4.0}, down, 0.0).distance, 3.0, kTolerance);
  const ExactScene lying = sceneOf(
      R"({"type": "cylinder", "center": [5, 0, 0], "radius": 1, "length": 2, "axis": [1, 0, 0]})");
  EXPECT_NEAR(alongX(lying, 0.9, 0.0), 4.0, kTolerance);
}

TEST(ExactSceneRayTest, MeetsTheNearestThatIsThere) {
  const ExactScene scene = sceneFrom(kWallAndBall);
  const Eigen::Vector3d start(0.0, 3.0, 1.0);
  EXPECT_NEAR(scene.firstHit(start, kForward, 0.0).distance, 4.0, kTolerance);
  EXPECT_NEAR(scene.firstHit(start, kForward, 1.5).distance, 1.5, kTolerance);
  EXPECT_EQ(scene.firstHit(start, -kForward, 1.5).shape, nullptr);
}

TEST(ExactSceneTimeTest, RemembersOnlyWhatPassedUpToATime) {
  const ExactScene scene = sceneFrom(kWallAndBall);
  const Eigen::Vector3d middle(2.0, 3.0, 1.0);
  EXPECT_TRUE(std::isinf(scene.distanceToPassing(middle, 0.5)));
  EXPECT_NEAR(scene.distanceToPassing(middle, 1.5), -0.5, kTolerance);
  EXPECT_NEAR(scene.distanceToPassing(middle), -0.5, kTolerance);
}

class TruthTest : public testing::Test {
 protected:
  TruthTest() : scene_(sceneFrom(kWallAndBall)), surface_(scene_, 8.0), grid_({64, 64, 32}) {
    grid_.moveTo({0, -32, 0}, &changes_);
  }

  /// One reading in the direction (1, dy, 0), put off by noise.
  void see(double y, double time, double noise = 0.0) {
    RangeData scan;
    scan.origin = {0.0, y, 1.01};
    scan.returns.push_back({static_cast<float>(4.0 + noise), 0.0f, 0.0f});
    surface_.add(scan, time);
  }

  TruthCount compare(const std::vector<VoxelIndex>& occupied, double time) {
    grid_.clear();
    for (const VoxelIndex& v : occupied) grid_.set(Plane::kOccupied, v, true);
    Snapshot::Info info;
    info.resolution = 0.1;
    const Snapshot map(&grid_, info);
    TruthCount count;
    compareWithScene(map, scene_, surface_, map.window(), time, &count);
    return count;
  }

  ExactScene scene_;
  SeenSurface surface_;
  ChangeSet changes_;
  SlidingGrid grid_;
};

TEST_F(TruthTest, CountsVoxelsThatTheSurfaceCannotCross) {
  // Centres at x = 4.05 and 3.95 are within half a diagonal (0.087 m) of the face, 3.85 is not.
  const TruthCount count = compare({{40, 0, 10}, {39, 0, 10}, {38, 0, 10}, {41, 0, 10}}, 0.0);
  EXPECT_EQ(count.occupied, 4u);
  EXPECT_EQ(count.off, 2u);
  EXPECT_DOUBLE_EQ(count.half(), 0.5);
}

TEST_F(TruthTest, FindsSeenCellsInTheirVoxelOrAFaceNeighbour) {
  for (int i = 0; i < 5; ++i) see(0.01, 0.0);  // noise does not matter
  see(0.51, 0.0, 0.3);
  see(1.01, 0.0, -0.2);
  const TruthCount count = compare({{40, 0, 10}, {41, 5, 10}, {41, 11, 10}}, 0.0);
  EXPECT_EQ(count.seen, 3u);
  EXPECT_EQ(count.seen_found, 2u);  // (41, 11, 10) shares an edge only with the third's voxel
  EXPECT_EQ(count.often, 1u);
  EXPECT_EQ(count.often_found, 1u);
}

TEST_F(TruthTest, SeesASurfaceOnACellBoundaryInTheCellBehindIt) {
  for (int i = 0; i < 1000; ++i) {  // the wall's face is at x = 4, which is where a cell begins
    RangeData scan;
    scan.origin = {0.1 + 0.0037 * i, 0.0, 1.0};
    scan.returns.push_back({1.0f, -0.5f + 0.00091f * i, 0.3f - 0.00057f * i});
    surface_.add(scan, 0.0);
  }
  surface_.forEach([](const Eigen::Vector3d& center_W, int) {
    EXPECT_NEAR(center_W.x(), 4.0 + SeenSurface::kCell / 2.0, kTolerance);
  });
}

TEST_F(TruthTest, LeavesOutWhatIsNearAPassingShape) {
  see(3.01, 1.5);  // meets the ball
  const TruthCount count = compare({{20, 30, 10}}, 1.5);
  EXPECT_EQ(count.occupied, 0u);
  EXPECT_EQ(count.seen, 0u);
}

TEST_F(TruthTest, CountsWhatAMovingObstacleLeftBehind) {
  const std::vector<VoxelIndex> in_the_ball = {{20, 30, 10}, {22, 30, 10}};
  const std::vector<VoxelIndex> beside_it = {{26, 30, 10}};  // 0.15 m outside
  EXPECT_EQ(compare(in_the_ball, 0.5).leftover, 0u);         // not there yet
  EXPECT_EQ(compare(in_the_ball, 1.5).leftover, 0u);         // there
  EXPECT_EQ(compare(in_the_ball, 2.5).leftover, 2u);
  EXPECT_EQ(compare(beside_it, 2.5).leftover, 0u);
}

TEST(TruthCommandTest, ComparesTheSampleFlight) {
  const TemporaryFile json_file("");
  TruthOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  options.input.json = json_file.path();
  options.scene = FIIMAP_SOURCE_DIR "/data/synth_flight_scene.json";
  options.resolutions = {0.2};
  options.snapshots = 4;
  ASSERT_EQ(evaluateTruth(options), 0);

  nlohmann::json json;
  std::ifstream(json_file.path()) >> json;
  EXPECT_EQ(json.at("integrated"), 110);
  ASSERT_EQ(json.at("results").size(), 1u);
  const nlohmann::json& row = json.at("results")[0];
  EXPECT_EQ(row.at("snapshots"), 4);
  EXPECT_GT(row.at("half"), 0.0);
  EXPECT_LT(row.at("half"), 0.06);
  EXPECT_GE(row.at("recall_5"), 0.995);
  EXPECT_GT(row.at("recall_any"), 0.94);
  EXPECT_GT(row.at("cells_any"), row.at("cells_5"));
}

TEST(TruthCommandTest, NeedsAScene) {
  TruthOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  EXPECT_THROW(evaluateTruth(options), std::invalid_argument);
  options.scene = "/nowhere/scene.json";
  EXPECT_THROW(evaluateTruth(options), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
