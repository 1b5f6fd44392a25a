#include "fiimap/decay.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/mapper.h"
#include "mapper_fixture.h"

/// Examples; MapperModelTest looks at every voxel of random flights.
namespace fiimap {
namespace {

using test::poseAt;
using test::smallConfig;
using Vector = Eigen::Vector3d;

constexpr std::int64_t kSecond = 1000000000, kStep = kSecond / 10;
constexpr double kDecayTime = 2.0;  // s
constexpr std::int64_t kDecaySteps = 20;

MapperConfig decayingConfig() {
  MapperConfig config = smallConfig();
  config.decay_time = kDecayTime;
  return config;
}

/// A camera that stands still and takes ten images a second.
class DecayTest : public ::testing::Test {
 protected:
  explicit DecayTest(const MapperConfig& config = decayingConfig()) : mapper_(config) {}

  void see(const PointScan& points, std::int64_t steps) {
    for (; steps > 0; --steps) mapper_.integrate(points, poseAt(kOrigin, stamp_ += kStep));
  }

  Occupancy at(const Vector& point_W) { return mapper_.snapshot()->occupancy(point_W); }
  Inflation inflatedAt(const Vector& point_W) { return mapper_.snapshot()->inflation(point_W); }

  const Vector kOrigin{0.1, 0.1, 0.1};
  const PointScan kAhead{{{2.0f, 0.0f, 0.0f}}}, kBehind{{{-2.0f, 0.0f, 0.0f}}};
  const Vector kObstacle = kOrigin + Vector(2.0, 0.0, 0.0);
  const Vector kFree = kOrigin + Vector(1.0, 0.0, 0.0);

  Mapper mapper_;
  std::int64_t stamp_ = 0;
};

TEST_F(DecayTest, WhatNoScanSeesIsKnownForOneTimeAndUnknownAfterTwo) {
  see(kAhead, 5);
  const Vector beside = kObstacle + Vector(0.0, 0.3, 0.0);
  ASSERT_EQ(inflatedAt(beside), Inflation::kInflated);
  for (std::int64_t step = 1; step <= 2 * kDecaySteps; ++step) {
    see(kBehind, 1);
    if (step < kDecaySteps) {
      ASSERT_EQ(at(kObstacle), Occupancy::kOccupied) << step;
      ASSERT_EQ(at(kFree), Occupancy::kFree) << step;
    }
    ASSERT_NE(at(kObstacle), Occupancy::kFree) << "nobody saw it empty";
  }
  EXPECT_EQ(at(kObstacle), Occupancy::kUnknown);
  EXPECT_EQ(at(kFree), Occupancy::kUnknown);
  EXPECT_EQ(inflatedAt(beside), Inflation::kUnknown);
  EXPECT_EQ(mapper_.grid().count(Plane::kOccupied), 1) << "what is behind, which scans see";
}

TEST_F(DecayTest, WhatScansSeeStaysHoweverSureItIs) {
  see(kAhead, 10 * kDecaySteps);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
  EXPECT_EQ(at(kFree), Occupancy::kFree);
}

TEST_F(DecayTest, AForgottenObstacleIsReportedOnceAndSeenAgainFromTheBeginning) {
  see(kAhead, 5);
  std::size_t raised = 0;
  for (std::int64_t step = 0; step < 2 * kDecaySteps; ++step) {
    raised += mapper_.integrate(kBehind, poseAt(kOrigin, stamp_ += kStep)).raise;
  }
  EXPECT_EQ(raised, 1u);
  see(kAhead, mapper_.logOdds().hitsToOccupy() - 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kFree) << "log-odds of before";
  see(kAhead, 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
}

TEST_F(DecayTest, AGapBetweenScansCountsAsOneTimeAtMost) {
  see(kAhead, 5);
  stamp_ += 1000 * kDecaySteps * kStep;
  see(kBehind, 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
  see(kBehind, kDecaySteps);
  EXPECT_EQ(at(kObstacle), Occupancy::kUnknown);
}

TEST_F(DecayTest, AScanThatComesLateForgetsNothing) {
  see(kAhead, 5);
  for (int scan = 0; scan < 1000; ++scan) mapper_.integrate(kBehind, poseAt(kOrigin, stamp_ - 1));
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
}

TEST_F(DecayTest, StampsMayBeginAgainAfterAReset) {
  stamp_ = 1000 * kSecond;
  see(kAhead, 5);
  mapper_.reset();
  stamp_ = 0;
  see(kAhead, 5);
  see(kBehind, 2 * kDecaySteps);
  EXPECT_EQ(at(kObstacle), Occupancy::kUnknown);
}

TEST_F(DecayTest, WhatIsWrittenByHandIsForgottenLikewise) {
  see(kBehind, 1);
  const VoxelIndex voxel = mapper_.snapshot()->lattice().indexOf(kObstacle);
  mapper_.overwrite({{voxel, voxel.array() + 1}}, Occupancy::kOccupied);
  see(kBehind, kDecaySteps - 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
  see(kBehind, kDecaySteps + 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kUnknown);
}

TEST_F(DecayTest, AMapInWhichNothingIsLeftHasNoMemory) {
  see(kAhead, 5);
  EXPECT_LE(mapper_.grid().memoryBytes(), mapper_.grid().worstCaseMemoryBytes());
  see(PointScan(), 4 * kDecaySteps);
  EXPECT_EQ(mapper_.grid().count(Plane::kKnown), 0);
  EXPECT_TRUE(mapper_.grid().liveSlots().empty());
}

TEST_F(DecayTest, ASnapshotKeepsWhatTheMapForgets) {
  see(kAhead, 5);
  const auto snapshot = mapper_.snapshot();
  see(kBehind, 2 * kDecaySteps);
  EXPECT_EQ(snapshot->occupancy(kObstacle), Occupancy::kOccupied);
}

TEST_F(DecayTest, SwitchedOnInFlightWhatIsInTheMapCountsAsSeen) {
  mapper_.reconfigure(smallConfig());
  see(kAhead, 5);
  see(kBehind, 10 * kDecaySteps);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied) << "it is switched off";
  mapper_.reconfigure(decayingConfig());
  see(kBehind, kDecaySteps - 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kOccupied);
  see(kBehind, kDecaySteps + 1);
  EXPECT_EQ(at(kObstacle), Occupancy::kUnknown);
}

}  // namespace
}  // namespace fiimap
