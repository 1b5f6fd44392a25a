#include "fiimap/ros/box_query.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "../core/oracle.h"

namespace fiimap {
namespace {

constexpr double kBoxResolution = 0.5;
constexpr int kInflatedFactor = 4;

class BoxQueryTest : public testing::Test {
 protected:
  BoxQueryTest() : grid_(VoxelIndex(8, 6, 4)) {}

  Snapshot snapshot() {
    Snapshot::Info info;
    info.stamp_ns = 1600000000123456789;
    info.resolution = kBoxResolution;
    return Snapshot(&grid_, info);
  }
  static GetBox::Request request(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    GetBox::Request request;
    request.min.x = min.x();
    request.min.y = min.y();
    request.min.z = min.z();
    request.max.x = max.x();
    request.max.y = max.y();
    request.max.z = max.z();
    return request;
  }
  std::string refusal(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    const GetBox::Response response = queryBox(snapshot(), request(min, max), "map");
    EXPECT_NE(response.success, !response.message.empty());
    EXPECT_EQ(response.voxels.empty(), !response.success);
    return response.message;
  }

  SlidingGrid grid_;
};

TEST_F(BoxQueryTest, TellsBothLayersOfEveryVoxel) {
  test::Random random(551);
  const VoxelBox window = grid_.window();
  test::forEachVoxel(window, [&](const VoxelIndex& v) {
    const int state = test::uniformInt(random, 0, 3);
    grid_.set(Plane::kKnown, v, state > 0);
    grid_.set(Plane::kOccupied, v, state > 1);
    grid_.set(Plane::kInflated, v, state > 1 || test::uniformInt(random, 0, 1) == 1);
  });
  const Snapshot map = snapshot();
  // One voxel more than the window at each side, from points within the first and last ones.
  const VoxelBox box{window.min.array() - 1, window.max.array() + 1};
  const GetBox::Response response = queryBox(
      map, request(map.lattice().centerOf(box.min), map.lattice().centerOf(box.max.array() - 1)),
      "map");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.header.frame_id, "map");
  EXPECT_EQ(response.header.stamp.toNSec(), 1600000000123456789u);
  EXPECT_EQ(response.resolution, kBoxResolution);
  EXPECT_EQ(response.origin.x, box.min.x() * kBoxResolution);
  EXPECT_EQ(response.origin.y, box.min.y() * kBoxResolution);
  EXPECT_EQ(response.origin.z, box.min.z() * kBoxResolution);
  ASSERT_EQ((VoxelIndex(response.size_x, response.size_y, response.size_z)), box.size());
  ASSERT_EQ(response.voxels.size(), static_cast<std::size_t>(box.volume()));
  test::forEachVoxel(box, [&](const VoxelIndex& v) {
    const VoxelIndex at = v - box.min;
    const int state = response.voxels[at.z() + box.size().z() * (at.y() + box.size().y() * at.x())];
    EXPECT_EQ(state % kInflatedFactor, static_cast<int>(map.occupancy(v)));
    EXPECT_EQ(state / kInflatedFactor, static_cast<int>(map.inflation(v)));
  });
}

TEST_F(BoxQueryTest, APointIsABoxOfOneVoxel) {
  const GetBox::Response response =
      queryBox(snapshot(), request({0.2, 0.2, 0.2}, {0.2, 0.2, 0.2}), "map");
  ASSERT_TRUE(response.success);
  EXPECT_EQ(response.voxels.size(), 1u);
}

TEST_F(BoxQueryTest, BadBoxesAreRefusedWithTheReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_EQ(refusal(zero, zero), "");
  EXPECT_NE(refusal({nan, 0, 0}, zero).find("finite"), std::string::npos);
  EXPECT_NE(refusal(zero, {0, infinity, 0}).find("finite"), std::string::npos);
  EXPECT_NE(refusal(zero, {0, 0, 1e300}).find("finite"), std::string::npos);
  EXPECT_NE(refusal({1, 0, 0}, zero).find("less than min"), std::string::npos);
  EXPECT_NE(refusal(zero, {1e4, 1e4, 1e4}).find("at most 16777216 voxels"), std::string::npos);
}

}  // namespace
}  // namespace fiimap
