#include "fiimap/scan_integrator.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "effort.h"
#include "oracle.h"

/// One observation per voxel and scan, against a model with one number per voxel (invariants 2, 3).
namespace fiimap {
namespace {

/// Log-odds of every known voxel.
class OccupancyModel {
 public:
  explicit OccupancyModel(const LogOdds& log_odds) : log_odds_(log_odds) {}

  void observe(const VoxelIndex& v, bool is_hit, test::VoxelSet* lower, test::VoxelSet* raise) {
    const bool before = isOccupied(v);
    int& value = values_[v];
    value = std::clamp<int>(value + (is_hit ? log_odds_.hit : log_odds_.miss), log_odds_.min,
                            log_odds_.max);
    const bool after = isOccupied(v);
    if (after && !before) lower->insert(v);
    if (before && !after) raise->insert(v);
  }
  void forgetOutside(const VoxelBox& window) {
    for (auto it = values_.begin(); it != values_.end();) {
      it = window.contains(it->first) ? std::next(it) : values_.erase(it);
    }
  }
  bool isOccupied(const VoxelIndex& v) const {
    const auto found = values_.find(v);
    return found != values_.end() && found->second >= log_odds_.threshold;
  }
  const std::map<VoxelIndex, int, test::VoxelLess>& values() const { return values_; }

 private:
  LogOdds log_odds_;
  std::map<VoxelIndex, int, test::VoxelLess> values_;
};

struct Observations {
  test::VoxelSet hits, misses;
};

/// Marks hits and free voxels, some of them both.
Observations randomScan(const VoxelBox& box, double hit_share, test::Random& random,
                        ScanMask* mask) {
  Observations observed;
  mask->begin(box);
  const int count =
      test::uniformInt(random, 0, static_cast<int>(std::min<std::int64_t>(box.volume(), 300)));
  for (int i = 0; i < count; ++i) {
    const VoxelIndex v = test::voxelNearFaces(random, box);
    const VoxelIndex d = v - box.min;
    mask->touch(d.x(), d.y());
    const bool is_hit = test::chance(random, hit_share);
    if (is_hit) {
      mask->mark(ScanMask::kHit, d);
      observed.hits.insert(v);
    }
    if (!is_hit || test::chance(random, 0.3)) {
      const int top = std::min(d.z() + test::uniformInt(random, 0, 5), box.size().z() - 1);
      mask->markFreeRun(mask->columnOffset(d.x(), d.y()), d.z(), top);
      for (int z = d.z(); z <= top; ++z)
        observed.misses.insert(box.min + VoxelIndex(d.x(), d.y(), z));
    }
  }
  for (const VoxelIndex& v : observed.hits) observed.misses.erase(v);
  return observed;
}

class IntegratorHistory {
 public:
  IntegratorHistory(const MapperConfig& config, const VoxelIndex& size, test::Random* random)
      : random_(*random), grid_(size), integrator_(LogOdds(config)), model_(LogOdds(config)) {}

  void scan() {
    const VoxelBox window = grid_.window();
    const VoxelIndex a = test::voxelNearFaces(random_, window);
    const VoxelIndex b = test::voxelNearFaces(random_, window);
    const VoxelBox part{a.cwiseMin(b), a.cwiseMax(b) + VoxelIndex::Ones()};
    const Observations observed =
        randomScan(test::chance(random_, 0.5) ? window : part, hit_share_, random_, &mask_);
    test::VoxelSet lower, raise;
    for (const VoxelIndex& v : observed.hits) model_.observe(v, true, &lower, &raise);
    for (const VoxelIndex& v : observed.misses) model_.observe(v, false, &lower, &raise);

    ChangeSet changes;
    integrator_.apply(mask_, &grid_, &changes);
    expectList(changes.lower, lower);
    expectList(changes.raise, raise);
    ASSERT_TRUE(changes.forgotten.empty());
    hit_share_ = test::uniformReal(random_, 0.0, 1.0);
  }

  void slide() {
    ChangeSet changes;
    grid_.moveTo(grid_.window().min + test::randomSlide(random_, grid_.window().size()), &changes);
    model_.forgetOutside(grid_.window());
  }

  void check() {
    test::VoxelField known(grid_.window()), occupied(grid_.window());
    for (const auto& [v, value] : model_.values()) {
      known.mark(v);
      if (model_.isOccupied(v)) occupied.mark(v);
      ASSERT_EQ(grid_.logOdds(v.x(), v.y())[grid_.layout().bitOf(v.z())], value)
          << test::describe(v);
    }
    ASSERT_TRUE(test::planeEquals(grid_, Plane::kKnown, known));
    ASSERT_TRUE(test::planeEquals(grid_, Plane::kOccupied, occupied));
    ASSERT_EQ(grid_.count(Plane::kInflated), 0) << "is the inflater's";
  }

 private:
  static void expectList(const std::vector<VoxelIndex>& list, const test::VoxelSet& expected) {
    EXPECT_EQ(test::VoxelSet(list.begin(), list.end()), expected);
    EXPECT_EQ(list.size(), expected.size()) << "a voxel appears twice";
  }

  test::Random& random_;
  SlidingGrid grid_;
  ScanIntegrator integrator_;
  OccupancyModel model_;
  ScanMask mask_;
  double hit_share_ = 0.5;
};

MapperConfig probabilities(double hit, double miss, double min, double max, double occ) {
  MapperConfig config;
  config.p_hit = hit;
  config.p_miss = miss;
  config.p_min = min;
  config.p_max = max;
  config.p_occ = occ;
  return config;
}

/// The defaults; one that flips at every scan; strong clamps; a clamp that is hardly below the
/// prior, so that it is the prior in fixed point; steps as large as the range.
const MapperConfig kConfigs[] = {MapperConfig(), probabilities(0.9, 0.1, 0.05, 0.95, 0.6),
                                 probabilities(0.7, 0.4, 0.3, 0.8, 0.75),
                                 probabilities(0.7, 0.499, 0.4985, 0.97, 0.8),
                                 probabilities(0.999, 0.002, 0.001, 0.999, 0.501)};

class ScanIntegratorTest : public ::testing::TestWithParam<VoxelIndex> {};

TEST_P(ScanIntegratorTest, AgreesWithOneNumberPerVoxel) {
  unsigned seed = 0;
  for (const MapperConfig& config : kConfigs) {
    test::Random random(++seed);
    IntegratorHistory history(config, GetParam(), &random);
    for (int step = 0; step < test::effort(60); ++step) {
      SCOPED_TRACE("seed and configuration " + std::to_string(seed) + ", step " +
                   std::to_string(step));
      if (test::chance(random, 0.3)) history.slide();
      ASSERT_NO_FATAL_FAILURE(history.scan());
      ASSERT_NO_FATAL_FAILURE(history.check());
      if (HasFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ScanIntegratorTest,
                         ::testing::Values(VoxelIndex(1, 1, 1), VoxelIndex(7, 5, 1),
                                           VoxelIndex(9, 8, 30), VoxelIndex(3, 35, 60),
                                           VoxelIndex(6, 5, 63), VoxelIndex(5, 6, 64),
                                           VoxelIndex(4, 6, 65), VoxelIndex(3, 5, 120),
                                           VoxelIndex(3, 3, 128), VoxelIndex(2, 4, 130)),
                         [](const auto& info) {
                           return std::to_string(info.param.x()) + "x" +
                                  std::to_string(info.param.y()) + "x" +
                                  std::to_string(info.param.z());
                         });

/// One voxel, observed by hand.
class OneVoxel {
 public:
  explicit OneVoxel(const MapperConfig& config = MapperConfig())
      : grid_({5, 5, 5}), integrator_(LogOdds(config)) {}

  ChangeSet observe(bool hit, bool free) {
    ScanMask mask;
    mask.begin(grid_.window());
    const VoxelIndex d = -grid_.window().min;
    mask.touch(d.x(), d.y());
    if (hit) mask.mark(ScanMask::kHit, d);
    if (free) mask.mark(ScanMask::kFree, d);
    ChangeSet changes;
    integrator_.apply(mask, &grid_, &changes);
    return changes;
  }
  void leaveAndComeBack() {
    const VoxelIndex min = grid_.window().min;
    ChangeSet changes;
    grid_.moveTo(min + VoxelIndex(0, 0, 64), &changes);
    grid_.moveTo(min, &changes);
  }
  bool is(Plane plane) const { return grid_.test(plane, VoxelIndex::Zero()); }

 private:
  SlidingGrid grid_;
  ScanIntegrator integrator_;
};

TEST(ScanIntegratorVoxelTest, AHitWinsOverAMiss) {
  OneVoxel voxel;
  EXPECT_TRUE(voxel.observe(true, true).lower.empty());
  EXPECT_TRUE(voxel.observe(true, true).lower.empty());
  EXPECT_EQ(voxel.observe(true, true).lower, std::vector<VoxelIndex>{VoxelIndex::Zero()})
      << "three hits occupy by default";
  EXPECT_TRUE(voxel.is(Plane::kOccupied));
}

TEST(ScanIntegratorVoxelTest, AMissMakesItKnownAndFree) {
  OneVoxel voxel;
  EXPECT_FALSE(voxel.is(Plane::kKnown));
  EXPECT_TRUE(voxel.observe(false, true).empty());
  EXPECT_TRUE(voxel.is(Plane::kKnown));
  EXPECT_FALSE(voxel.is(Plane::kOccupied));
}

TEST(ScanIntegratorVoxelTest, ClampingLetsAnOldObstacleVanish) {
  OneVoxel voxel;
  for (int i = 0; i < 1000; ++i) voxel.observe(true, false);
  int misses = 0;
  while (voxel.is(Plane::kOccupied) && misses < 1000) voxel.observe(false, true), ++misses;
  EXPECT_EQ(misses, 3) << "from log-odds 3.476 below 1.386 by steps of .847";
  for (int i = 0; i < 1000; ++i) voxel.observe(false, true);
  int hits = 0;
  while (!voxel.is(Plane::kOccupied) && hits < 1000) voxel.observe(true, false), ++hits;
  EXPECT_EQ(hits, 6) << "from log-odds -1.992 to 1.386 by steps of .619";
}

TEST(ScanIntegratorVoxelTest, WhatComesBackStartsAtThePrior) {
  OneVoxel voxel;
  for (int i = 0; i < 20; ++i) voxel.observe(true, false);
  voxel.leaveAndComeBack();
  EXPECT_FALSE(voxel.is(Plane::kKnown));
  EXPECT_TRUE(voxel.observe(true, false).lower.empty()) << "the old certainty is still there";
  EXPECT_TRUE(voxel.observe(true, false).lower.empty());
  EXPECT_EQ(voxel.observe(true, false).lower.size(), 1u);
}

TEST(ScanIntegratorVoxelTest, WhatComesBackStartsAtThePriorAlsoWhenTheClampIsThePrior) {
  OneVoxel voxel(kConfigs[3]);
  for (int i = 0; i < 20; ++i) voxel.observe(true, false);
  voxel.leaveAndComeBack();
  EXPECT_TRUE(voxel.observe(false, true).lower.empty());
  EXPECT_TRUE(voxel.observe(false, true).lower.empty()) << "the old certainty is still there";
  EXPECT_FALSE(voxel.is(Plane::kOccupied));
}

TEST(ScanIntegratorVoxelTest, AppendsToTheListsItGets) {
  SlidingGrid grid({3, 3, 3});
  ScanIntegrator integrator{LogOdds(MapperConfig())};
  ScanMask mask;
  mask.begin(grid.window());
  mask.touch(1, 1);
  mask.mark(ScanMask::kHit, {1, 1, 1});
  ChangeSet changes;
  changes.lower = {{7, 7, 7}};
  for (int i = 0; i < 3; ++i) integrator.apply(mask, &grid, &changes);
  EXPECT_EQ(changes.lower, (std::vector<VoxelIndex>{{7, 7, 7}, {0, 0, 0}}));
}

}  // namespace
}  // namespace fiimap
