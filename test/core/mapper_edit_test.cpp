// What users and services do to a map: overwrite and placeWindow, by examples. MapperModelTest and
// MapperInflationTest hold them to their definition.

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fiimap/mapper.h"
#include "mapper_fixture.h"

namespace fiimap {
namespace {

using test::centerOfWindow;
using test::poseAt;
using test::seeAnObstacle;
using test::smallConfig;
using test::State;

const Eigen::Vector3d kHere(0.125, 0.125, 0.125);
const VoxelIndex kObstacle(8, 0, 0);  // that seeAnObstacle sees from there

VoxelBox only(const VoxelIndex& v) { return {v, v + VoxelIndex::Ones()}; }

/// Scans of the obstacle until it is occupied.
int scansToOccupy(Mapper* mapper) {
  int scans = 0;
  while (mapper->snapshot()->occupancy(kObstacle) != Occupancy::kOccupied && scans < 100) {
    mapper->integrate({{Eigen::Vector3f(2.0f, 0.0f, 0.0f)}}, poseAt(kHere));
    ++scans;
  }
  return scans;
}

/// Scans through the obstacle until it is free.
int scansToFree(Mapper* mapper) {
  int scans = 0;
  while (mapper->snapshot()->occupancy(kObstacle) != Occupancy::kFree && scans < 100) {
    mapper->integrate({{Eigen::Vector3f(2.5f, 0.0f, 0.0f)}}, poseAt(kHere));
    ++scans;
  }
  return scans;
}

TEST(MapperEditTest, AVoxelMadeUnknownIsAsIfItHadNeverBeenSeen) {
  Mapper mapper(smallConfig());
  mapper.integrate(PointScan(), poseAt(kHere));
  const int scans = scansToOccupy(&mapper);
  EXPECT_EQ(scans, mapper.logOdds().hitsToOccupy());
  for (int i = 0; i < 10; ++i) seeAnObstacle(&mapper, kHere);
  EXPECT_EQ(mapper.overwrite({only(kObstacle)}, Occupancy::kUnknown), 1);
  EXPECT_EQ(mapper.snapshot()->occupancy(kObstacle), Occupancy::kUnknown);
  EXPECT_EQ(mapper.snapshot()->count(Plane::kInflated), 0);
  EXPECT_EQ(scansToOccupy(&mapper), scans);
}

TEST(MapperEditTest, AVoxelMadeOccupiedIsClearedLikeOneThatWasSeenForLong) {
  Mapper seen(smallConfig()), edited(smallConfig());
  for (int i = 0; i < 30; ++i) seeAnObstacle(&seen, kHere);
  edited.integrate(PointScan(), poseAt(kHere));
  EXPECT_EQ(edited.overwrite({only(kObstacle)}, Occupancy::kOccupied), 1);
  EXPECT_EQ(edited.snapshot()->count(Plane::kInflated), seen.snapshot()->count(Plane::kInflated));
  const int scans = scansToFree(&seen);
  EXPECT_EQ(scans, seen.logOdds().missesToClear());
  EXPECT_EQ(scansToFree(&edited), scans);
}

TEST(MapperEditTest, AVoxelMadeFreeIsOccupiedAgainLikeOneThatWasSeenThroughForLong) {
  Mapper seen(smallConfig()), edited(smallConfig());
  seeAnObstacle(&edited, kHere);
  for (int i = 0; i < 30; ++i) {
    seen.integrate({{Eigen::Vector3f(2.5f, 0.0f, 0.0f)}}, poseAt(kHere));
  }
  edited.overwrite({only(kObstacle)}, Occupancy::kFree);
  EXPECT_EQ(edited.snapshot()->occupancy(kObstacle), Occupancy::kFree);
  EXPECT_EQ(edited.snapshot()->count(Plane::kInflated), 0);
  EXPECT_EQ(scansToOccupy(&edited), scansToOccupy(&seen));
}

TEST(MapperEditTest, VoxelsOutsideOfTheWindowAreLeftOut) {
  Mapper mapper(smallConfig());
  mapper.integrate(PointScan(), poseAt(kHere));
  const VoxelBox window = mapper.grid().window();
  const VoxelBox all{VoxelIndex::Constant(-(1 << 30)), VoxelIndex::Constant(1 << 30)};
  EXPECT_EQ(mapper.overwrite({all}, Occupancy::kFree), window.volume());
  EXPECT_EQ(mapper.snapshot()->count(Plane::kKnown), window.volume());
  EXPECT_EQ(mapper.overwrite({only(window.max)}, Occupancy::kOccupied), 0);
  EXPECT_EQ(mapper.overwrite({VoxelBox{{5, 5, 5}, {2, 9, 9}}}, Occupancy::kOccupied), 0) << "empty";
  EXPECT_EQ(mapper.overwrite({}, Occupancy::kOccupied), 0);
  EXPECT_EQ(mapper.snapshot()->count(Plane::kOccupied), 0);
}

TEST(MapperEditTest, OutsideIsNoStateToWrite) {
  Mapper mapper(smallConfig());
  mapper.integrate(PointScan(), poseAt(kHere));
  EXPECT_THROW(mapper.overwrite({only(kObstacle)}, Occupancy::kOutside), std::invalid_argument);
}

TEST(MapperEditTest, BeforeTheWindowIsPlacedThereIsNothingToWriteTo) {
  Mapper mapper(smallConfig());
  EXPECT_FALSE(mapper.hasWindow());
  EXPECT_EQ(mapper.overwrite({only({0, 0, 0})}, Occupancy::kOccupied), 0);
  EXPECT_EQ(mapper.snapshot()->count(Plane::kKnown), 0);
}

TEST(MapperEditTest, PlacesTheWindowWhereTheFirstScanWould) {
  for (const MapMode mode : {MapMode::kSliding, MapMode::kFixed}) {
    MapperConfig config = smallConfig();
    config.map_mode = mode;
    config.map_center_x = 50.0;
    const Eigen::Vector3d vehicle_W(-1234.5, 77.7, -3.3);
    Mapper scanned(config), placed(config);
    scanned.integrate(PointScan(), poseAt(vehicle_W));
    placed.placeWindow(vehicle_W);
    EXPECT_TRUE(placed.hasWindow());
    EXPECT_EQ(placed.grid().window(), scanned.grid().window());
    placed.placeWindow({0, 0, 0});
    EXPECT_EQ(placed.grid().window(), scanned.grid().window()) << "only once";
    placed.reset();
    EXPECT_FALSE(placed.hasWindow());
  }
}

TEST(MapperEditTest, WhatWasWrittenBeforeTheFirstScanStaysAsFarAsTheWindowGoesOnCoveringIt) {
  Mapper mapper(smallConfig());
  mapper.placeWindow(kHere);
  const VoxelBox window = mapper.grid().window();
  EXPECT_EQ(mapper.overwrite({window}, Occupancy::kOccupied), window.volume());
  mapper.integrate(PointScan(), poseAt(kHere + Eigen::Vector3d(2.0, 0.0, 0.0), 5));
  EXPECT_EQ(mapper.grid().window().min, (window.min + VoxelIndex(8, 0, 0)));
  const VoxelBox kept = window.intersection(mapper.grid().window());
  const auto snapshot = mapper.snapshot();
  EXPECT_EQ(snapshot->count(Plane::kOccupied), kept.volume());
  EXPECT_EQ(snapshot->info().stamp_ns, 5);
}

TEST(MapperEditTest, PlacesNoWindowAtWhatIsNoPosition) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    Mapper mapper(smallConfig());
    EXPECT_THROW(mapper.placeWindow({0.0, bad, 0.0}), std::invalid_argument);
    EXPECT_FALSE(mapper.hasWindow());
  }
}

}  // namespace
}  // namespace fiimap
