#include "fiimap/ros/map_edits.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../core/mapper_fixture.h"
#include "fiimap/ros/geometry_messages.h"

namespace fiimap {
namespace {

using test::kResolution;

constexpr double kEverywhere = 1e7;  // m

ClearBox::Request box(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                      std::uint8_t state = ClearBox::Request::UNKNOWN) {
  ClearBox::Request request;
  request.min = toPoint(min);
  request.max = toPoint(max);
  request.state = state;
  return request;
}

template <typename Function>
std::string refusalOf(Function&& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

class MapEditsTest : public testing::Test {
 protected:
  MapEditsTest() : mapper_(test::smallConfig()) { test::seeAnObstacle(&mapper_, kVehicle); }

  std::string clearRefusal(const ClearBox::Request& request) {
    const test::State before(&mapper_);
    const std::string refusal = refusalOf([&] { clearBox(request, &mapper_); });
    EXPECT_TRUE(refusal.empty() || test::State(&mapper_) == before);
    return refusal;
  }
  /// A file of one obstacle and of free voxels around it that reach out of the window.
  static SavedMap savedMap() {
    SavedMap saved;
    saved.file = "room.bt";
    saved.resolution = kResolution;
    saved.occupied = {{{8, 3, 0}, {9, 4, 1}}};
    saved.free = {{{8, 4, -100}, {10, 6, 100}}, {{1000, 0, 0}, {1001, 1, 1}}};
    return saved;
  }

  const Eigen::Vector3d kVehicle{0.125, 0.125, 0.125};
  const VoxelIndex kObstacle{8, 0, 0};
  Mapper mapper_;
};

TEST_F(MapEditsTest, ClearsTheVoxelsThatTheBoxTouches) {
  // Up to a point in the obstacle's voxel, from one in the voxel before it.
  const ClearBox::Response response = clearBox(box({1.99, 0.1, 0.1}, {2.01, 0.2, 0.2}), &mapper_);
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.voxels, 2u);
  EXPECT_NE(response.message.find("2 voxels are unknown"), std::string::npos);
  const auto snapshot = mapper_.snapshot();
  EXPECT_EQ(snapshot->occupancy(kObstacle), Occupancy::kUnknown);
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(7, 0, 0)), Occupancy::kUnknown);
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(6, 0, 0)), Occupancy::kFree);
  EXPECT_EQ(snapshot->count(Plane::kInflated), 0);
}

TEST_F(MapEditsTest, FreesABox) {
  const ClearBox::Response response =
      clearBox(box({2.1, 0.1, 0.1}, {2.1, 0.1, 0.1}, ClearBox::Request::FREE), &mapper_);
  EXPECT_EQ(response.voxels, 1u);
  EXPECT_NE(response.message.find("free"), std::string::npos);
  EXPECT_EQ(mapper_.snapshot()->occupancy(kObstacle), Occupancy::kFree);
}

TEST_F(MapEditsTest, ABoxLargerThanAnyWindowIsTheWindow) {
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kEverywhere);
  const ClearBox::Response response = clearBox(box(-far, far), &mapper_);
  EXPECT_EQ(response.voxels, static_cast<std::uint64_t>(mapper_.grid().window().volume()));
  EXPECT_EQ(mapper_.snapshot()->count(Plane::kKnown), 0);
}

TEST_F(MapEditsTest, ABoxOutsideOfTheWindowHoldsNoVoxel) {
  EXPECT_EQ(clearBox(box({100, 0, 0}, {101, 1, 1}), &mapper_).voxels, 0u);
}

TEST_F(MapEditsTest, BadBoxesAreRefusedWithTheReason) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_NE(clearRefusal(box({std::nan(""), 0, 0}, zero)).find("finite"), std::string::npos);
  EXPECT_NE(clearRefusal(box(zero, {0, 0, 1e300})).find("finite"), std::string::npos);
  EXPECT_NE(clearRefusal(box({1, 0, 0}, zero)).find("less than min"), std::string::npos);
  EXPECT_NE(clearRefusal(box(zero, zero, 2)).find("state = 2: must be UNKNOWN (0) or FREE (1)"),
            std::string::npos);
  mapper_.reset();
  EXPECT_NE(clearRefusal(box(zero, zero)).find("no map yet"), std::string::npos);
}

TEST_F(MapEditsTest, ALoadedMapTakesThePlaceOfWhatItKnows) {
  const test::State before(&mapper_);
  const LoadMap::Response response = loadMap(savedMap(), LoadMap::Request(), &mapper_);
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.occupied, 1u);
  EXPECT_EQ(response.free, 48u) << "2 x 2 columns of 12 voxels";
  EXPECT_EQ(response.outside, 4u * (200 - 12) + 1);
  EXPECT_NE(response.message.find("1 occupied and 48 free voxels of room.bt"), std::string::npos);
  const auto snapshot = mapper_.snapshot();
  EXPECT_EQ(snapshot->window(), before.window);
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(8, 3, 0)), Occupancy::kOccupied);
  EXPECT_EQ(snapshot->inflation(VoxelIndex(10, 3, 0)), Inflation::kInflated);
  EXPECT_EQ(snapshot->occupancy(VoxelIndex(9, 5, 5)), Occupancy::kFree);
  EXPECT_EQ(snapshot->occupancy(kObstacle), Occupancy::kOccupied) << "of which it says nothing";
}

TEST_F(MapEditsTest, BeforeTheFirstScanTheWindowIsPlacedAroundTheVehicle) {
  mapper_.reset();
  LoadMap::Request request;
  request.vehicle = toPoint({250.0, 0.0, 0.0});
  const LoadMap::Response response = loadMap(savedMap(), request, &mapper_);
  EXPECT_EQ(response.free, 1u);
  EXPECT_EQ(response.occupied, 0u);
  EXPECT_TRUE(mapper_.grid().window().contains({1000, 0, 0}));
  EXPECT_EQ(mapper_.snapshot()->occupancy(VoxelIndex(1000, 0, 0)), Occupancy::kFree);
}

TEST_F(MapEditsTest, AMapOfAnotherResolutionIsRefused) {
  const test::State before(&mapper_);
  SavedMap saved = savedMap();
  saved.resolution = 0.2;
  const std::string refusal = refusalOf([&] { loadMap(saved, LoadMap::Request(), &mapper_); });
  EXPECT_NE(refusal.find("room.bt: has a resolution of 0.2 m, the map one of 0.25 m"),
            std::string::npos);
  EXPECT_TRUE(test::State(&mapper_) == before);
}

TEST_F(MapEditsTest, AVehicleThatIsNowhereIsRefused) {
  mapper_.reset();
  LoadMap::Request request;
  request.vehicle.y = std::nan("");
  EXPECT_NE(refusalOf([&] { loadMap(savedMap(), request, &mapper_); }).find("position"),
            std::string::npos);
  EXPECT_FALSE(mapper_.hasWindow());
}

}  // namespace
}  // namespace fiimap
