// Free space, inflation and obstacles that come and go, against a scene worked out by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "exact_scene.h"
#include "fiimap/structuring_element.h"
#include "temporary_file.h"
#include "truth/inflation_truth.h"
#include "truth/passed_voxels.h"
#include "truth/passing_margin.h"
#include "truth/passing_obstacles.h"
#include "truth_report.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.1;  // m
constexpr double kRadius = 0.2;      // m
constexpr double kMaxRange = 8.0;    // m

/// A wall whose near face is at x = 4.01, and a box at (2, 0, 1) that is there from t = 1 s to 2 s.
constexpr char kWallAndBox[] = R"({"t0": 0.0, "primitives": [
  {"type": "box", "center": [4.51, 0, 1], "size": [1, 20, 20]},
  {"type": "box", "center": [2, 0, 1], "size": [1, 1, 1], "t_on": 1.0, "t_off": 2.0}]})";

class TruthLayersTest : public testing::Test {
 protected:
  TruthLayersTest() : grid_({64, 80, 32}) {
    const TemporaryFile file(kWallAndBox);
    scene_ = ExactScene::load(file.path());
    ChangeSet changes;
    grid_.moveTo({0, -40, 0}, &changes);
  }

  /// Many rays along x, from x = 0 at this y.
  RangeData raysAt(double y) const {
    RangeData scan;
    scan.origin = {0.05, y, 1.06};
    for (std::size_t i = 0; i < PassedVoxels::kEveryReturn; ++i) {
      scan.returns.push_back({3.0f, 0.0f, 0.0f});  // noise does not matter
    }
    return scan;
  }

  Snapshot snapshot() {
    Snapshot::Info info;
    info.resolution = kResolution;
    info.inflation_radius = kRadius;
    return Snapshot(&grid_, info);
  }
  void set(const VoxelIndex& v, bool occupied) {
    grid_.set(Plane::kKnown, v, true);
    grid_.set(Plane::kOccupied, v, occupied);
  }

  ExactScene scene_;
  SlidingGrid grid_;
};

TEST_F(TruthLayersTest, FindsFreeSpaceThatRaysPassed) {
  PassedVoxels passed(kResolution, kMaxRange);
  passed.add(raysAt(2.06), scene_, 0.0);
  EXPECT_TRUE(passed.passed({39, 20, 10}));
  EXPECT_FALSE(passed.passed({40, 20, 10}));  // the surface is there
  for (int x = 0; x < 10; ++x) set({x, 20, 10}, false);
  set({10, 20, 10}, true);
  FreeSpaceCount count;
  const Snapshot map = snapshot();
  passed.compare(map, scene_, map.window(), 0.0, &count);
  // Voxels 0 to 38: the centre of the last, x = 3.85, is more than half a diagonal off the wall.
  EXPECT_EQ(count.free, 39u);
  EXPECT_EQ(count.found, 10u);
  EXPECT_EQ(count.occupied, 1u);
}

TEST_F(TruthLayersTest, LeavesOutFreeSpaceWhereThingsComeAndGo) {
  EXPECT_TRUE(isNearPassing(scene_, {2.9, 0.0, 1.0}, 0.5));
  EXPECT_FALSE(isNearPassing(scene_, {3.1, 0.0, 1.0}, 0.5));
  PassedVoxels passed(kResolution, kMaxRange);
  passed.add(raysAt(0.06), scene_, 0.0);
  FreeSpaceCount count;
  const Snapshot map = snapshot();
  passed.compare(map, scene_, map.window(), 0.0, &count);
  // Not the voxels from x = 1 to 3: 10 before, 9 behind.
  EXPECT_EQ(count.free, 19u);
}

class InflationTruthTest : public TruthLayersTest {
 protected:
  /// Compares after the wall was seen at y = 2.05, with these voxels inflated.
  nlohmann::json compareWith(const std::vector<VoxelIndex>& inflated) {
    SeenSurface surface(scene_, kMaxRange);
    for (int i = 0; i < TruthCount::kOften; ++i) surface.add(raysAt(2.06), 0.0);
    for (const VoxelIndex& v : inflated) grid_.set(Plane::kInflated, v, true);
    const Snapshot map = snapshot();
    InflationTruth truth;
    truth.compare(map, scene_, surface, map.window(), 0.0);
    return truth.json();
  }
};

TEST_F(InflationTruthTest, MissesWhatIsNotInflatedWithinTheRadius) {
  // The cell's centre is (4.025, 2.075, 1.075): voxels whose centres are within 0.2 m.
  std::vector<VoxelIndex> ball;
  for (int x = 36; x < 45; ++x) {
    for (int y = 16; y < 25; ++y) {
      for (int z = 6; z < 15; ++z) {
        const Eigen::Vector3d center_W = (Eigen::Vector3d(x, y, z).array() + 0.5) * kResolution;
        if ((center_W - Eigen::Vector3d(4.025, 2.075, 1.075)).norm() <= kRadius) {
          ball.emplace_back(x, y, z);
        }
      }
    }
  }
  const nlohmann::json empty = compareWith({});
  EXPECT_EQ(empty.at("required"), ball.size());
  EXPECT_EQ(empty.at("missing_share"), 1.0);
  EXPECT_NEAR(empty.at("least_clearance_m"), 0.025 * std::sqrt(3.0), 1e-9);
  const nlohmann::json full = compareWith(ball);
  EXPECT_EQ(full.at("missing_share"), 0.0);
  EXPECT_EQ(full.at("least_clearance_m"), kRadius);
  EXPECT_EQ(full.at("excess_share"), 0.0);
}

TEST_F(InflationTruthTest, CountsWhatIsInflatedBeyondTheRadius) {
  // Centres at x = 3.85 and 3.65: 0.16 m and 0.36 m before the wall.
  const nlohmann::json json = compareWith({{38, 30, 10}, {36, 30, 10}});
  EXPECT_EQ(json.at("inflated"), 2);
  EXPECT_EQ(json.at("excess_share"), 0.5);
  EXPECT_NEAR(json.at("excess_max_m"), 0.16, 1e-9);
}

TEST_F(TruthLayersTest, MeasuresHowLongAnObstacleTakesToAppearAndToVanish) {
  PassingObstacles obstacles(scene_);
  const VoxelIndex face(15, 0, 10);  // where the rays meet the box
  const RangeData rays = raysAt(0.06);
  const auto scanAt = [&](double time) { obstacles.add(rays, snapshot(), time); };
  scanAt(0.5);  // not there yet
  scanAt(1.2);  // seen
  scanAt(1.4);
  set(face, true);
  scanAt(1.6);  // in the map
  scanAt(2.5);  // gone, and seen through
  scanAt(2.8);
  set(face, false);
  scanAt(3.2);
  const nlohmann::json json = obstacles.json();
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0].at("primitive"), 1);
  EXPECT_NEAR(json[0].at("first_seen_s"), 1.2, 1e-9);
  EXPECT_NEAR(json[0].at("appear_s"), 0.4, 1e-9);
  EXPECT_EQ(json[0].at("scans_to_appear"), 3);
  EXPECT_EQ(json[0].at("cleared"), 1);
  EXPECT_NEAR(json[0].at("vanish_max_s"), 0.7, 1e-9);
  EXPECT_EQ(json[0].at("left"), 0);
}

TEST_F(TruthLayersTest, TellsWhatAnObstacleLeftBehind) {
  PassingObstacles obstacles(scene_);
  set({15, 0, 10}, true);
  set({15, 3, 10}, true);  // where no ray passes
  for (const double time : {1.5, 2.5}) {
    obstacles.add(raysAt(0.06), snapshot(), time);
  }
  const nlohmann::json json = obstacles.json();
  EXPECT_EQ(json[0].at("left"), 1);
  EXPECT_EQ(json[0].at("never_seen_through"), 1);
  EXPECT_EQ(json[0].at("cleared"), 0);
}

}  // namespace
}  // namespace fiimap
