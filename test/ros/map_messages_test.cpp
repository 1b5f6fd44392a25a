#include "fiimap/ros/map_messages.h"

#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include "fiimap/ros/map_handle_message.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.5;
constexpr std::int64_t kStamp = 1600000000123456789;

class MapMessagesTest : public testing::Test {
 protected:
  MapMessagesTest() : grid_(VoxelIndex(8, 6, 4)) {
    ChangeSet changes;
    grid_.moveTo(VoxelIndex(-4, -3, -2), &changes);
    for (const VoxelIndex& v : {VoxelIndex(-4, -3, -2), VoxelIndex(3, 2, 1), VoxelIndex(0, 0, 0)}) {
      grid_.set(Plane::kOccupied, v, true);
    }
  }
  Snapshot snapshot() {
    Snapshot::Info info;
    info.stamp_ns = kStamp;
    info.sequence = 7;
    info.resolution = kResolution;
    info.inflation_shape = ElementShape::kCube;
    info.inflation_radius = 1.25;
    return Snapshot(&grid_, info);
  }

  SlidingGrid grid_;
};

TEST_F(MapMessagesTest, CloudHoldsTheCentresOfTheVoxels) {
  const sensor_msgs::PointCloud2 cloud = toPointCloud(snapshot(), Plane::kOccupied, "map");
  EXPECT_EQ(cloud.header.frame_id, "map");
  EXPECT_EQ(cloud.header.stamp.toNSec(), static_cast<std::uint64_t>(kStamp));
  std::set<std::tuple<float, float, float>> points;
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z");
  for (; x != x.end(); ++x, ++y, ++z) points.emplace(*x, *y, *z);
  EXPECT_EQ(points, (std::set<std::tuple<float, float, float>>{
                        {-1.75F, -1.25F, -0.75F}, {1.75F, 1.25F, 0.75F}, {0.25F, 0.25F, 0.25F}}));
  EXPECT_EQ(cloud.data.size(), std::size_t{cloud.row_step});
}

TEST_F(MapMessagesTest, CloudOfAnEmptyPlaneIsValid) {
  const sensor_msgs::PointCloud2 cloud = toPointCloud(snapshot(), Plane::kInflated, "map");
  EXPECT_EQ(cloud.width, 0u);
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_EQ(cloud.fields.size(), 3u);
}

TEST_F(MapMessagesTest, MapInfoTellsWhatTheSnapshotTells) {
  const MapInfo info = toMapInfo(snapshot(), "/fiimap", "map");
  EXPECT_EQ(info.id, "/fiimap");
  EXPECT_EQ(info.sequence, 7u);
  EXPECT_DOUBLE_EQ(info.resolution, kResolution);
  EXPECT_EQ(info.window_min[0], -4);
  EXPECT_EQ(info.window_max[2], 2);
  EXPECT_DOUBLE_EQ(info.inflation_radius, 1.25);
  EXPECT_EQ(info.inflation_shape, MapInfo::SHAPE_CUBE);
}

TEST_F(MapMessagesTest, OutlineHasTwelveEdgesAlongTheAxes) {
  const visualization_msgs::Marker marker = toOutline(grid_.window(), snapshot(), "map", "window");
  ASSERT_EQ(marker.points.size(), 24u);
  for (std::size_t i = 0; i < marker.points.size(); i += 2) {
    const geometry_msgs::Point &a = marker.points[i], &b = marker.points[i + 1];
    EXPECT_DOUBLE_EQ(std::abs(a.x), 2.0);
    EXPECT_DOUBLE_EQ(std::abs(a.y), 1.5);
    EXPECT_DOUBLE_EQ(std::abs(a.z), 1.0);
    EXPECT_EQ((a.x != b.x) + (a.y != b.y) + (a.z != b.z), 1);
  }
}

TEST_F(MapMessagesTest, HandleMessageIsAPlainMapInfoOnTheWire) {
  MapHandleMessage message;
  message.info = toMapInfo(snapshot(), "/fiimap", "map");
  message.handle = std::make_shared<const MapHandle>("/fiimap");
  namespace traits = ros::message_traits;
  EXPECT_STREQ(traits::md5sum(message), traits::md5sum(message.info));
  EXPECT_STREQ(traits::datatype(message), traits::datatype(message.info));
  EXPECT_STREQ(traits::definition(message), traits::definition(message.info));

  const ros::SerializedMessage wire = ros::serialization::serializeMessage(message);
  MapInfo plain;
  ros::serialization::deserializeMessage(wire, plain);
  EXPECT_EQ(plain, message.info);
  MapHandleMessage received;
  ros::serialization::deserializeMessage(wire, received);
  EXPECT_EQ(received.info, message.info);
  EXPECT_EQ(received.handle, nullptr);
}

TEST_F(MapMessagesTest, HandleMessageFindsTheHandleOfItsProcess) {
  MapHandleMessage message;
  message.info = toMapInfo(snapshot(), "/of_this_process", "map");
  const auto handle = std::make_shared<const MapHandle>("/of_this_process");
  MapRegistry::add(handle);
  MapHandleMessage received;
  ros::serialization::deserializeMessage(ros::serialization::serializeMessage(message), received);
  EXPECT_EQ(received.handle, handle);
}

}  // namespace
}  // namespace fiimap
