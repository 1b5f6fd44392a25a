#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "fiimap/ros/message_conversions.h"
#include "messages.h"

namespace fiimap {
namespace {

constexpr std::uint32_t kPointStep = 24;
constexpr std::uint32_t kOffsetX = 4, kOffsetY = 12, kOffsetZ = 20;  // not adjacent

/// Cloud whose point in column u of row v is (u, v, 100 + u).
sensor_msgs::PointCloud2 makeCloud(std::uint32_t width, std::uint32_t height,
                                   std::uint32_t padding = 0) {
  sensor_msgs::PointCloud2 cloud;
  cloud.width = width;
  cloud.height = height;
  cloud.point_step = kPointStep;
  cloud.row_step = width * kPointStep + padding;
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * height, 0xEE);
  const std::uint32_t offsets[3] = {kOffsetX, kOffsetY, kOffsetZ};
  for (int axis = 0; axis < 3; ++axis) {
    sensor_msgs::PointField field;
    field.name = std::string("xyz").substr(axis, 1);
    field.offset = offsets[axis];
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  for (std::uint32_t v = 0; v < height; ++v) {
    for (std::uint32_t u = 0; u < width; ++u) {
      const float xyz[3] = {static_cast<float>(u), static_cast<float>(v), 100.0F + u};
      for (int axis = 0; axis < 3; ++axis) {
        std::memcpy(&cloud.data[v * cloud.row_step + u * kPointStep + offsets[axis]], &xyz[axis],
                    sizeof(float));
      }
    }
  }
  return cloud;
}

void expectPoints(const sensor_msgs::PointCloud2& cloud, int pixel_step, int used_step) {
  PointScan scan;
  decodePointCloud(cloud, pixel_step, &scan);
  std::size_t i = 0;
  for (std::uint32_t v = 0; v < cloud.height; v += used_step) {
    for (std::uint32_t u = 0; u < cloud.width; u += used_step) {
      ASSERT_LT(i, scan.points.size());
      EXPECT_EQ(scan.points[i++], Eigen::Vector3f(u, v, 100.0F + u));
    }
  }
  EXPECT_EQ(i, scan.points.size());
}

TEST(DecodePointCloudTest, ThinsOrganisedCloudsOnRowsAndColumns) {
  const sensor_msgs::PointCloud2 cloud = makeCloud(7, 5);
  expectPoints(cloud, 1, 1);
  expectPoints(cloud, 0, 1);
  expectPoints(cloud, 2, 2);
  expectPoints(cloud, 100, 100);
}

TEST(DecodePointCloudTest, NeverThinsListsOfPoints) { expectPoints(makeCloud(9, 1), 4, 1); }

TEST(DecodePointCloudTest, SkipsPaddingAtTheEndOfRows) { expectPoints(makeCloud(4, 3, 13), 1, 1); }

TEST(DecodePointCloudTest, KeepsPointsThatAreNotFinite) {
  sensor_msgs::PointCloud2 cloud = makeCloud(2, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&cloud.data[kOffsetX], &nan, sizeof(nan));
  PointScan scan;
  decodePointCloud(cloud, 1, &scan);
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_TRUE(std::isnan(scan.points[0].x()));
}

TEST(DecodePointCloudTest, TakesEmptyClouds) {
  PointScan scan;
  scan.points.resize(3);
  decodePointCloud(makeCloud(0, 1), 1, &scan);
  EXPECT_TRUE(scan.points.empty());
  sensor_msgs::PointCloud2 rows_of_nothing = makeCloud(0, 1);
  rows_of_nothing.height = std::numeric_limits<std::uint32_t>::max();
  decodePointCloud(rows_of_nothing, 1, &scan);
  EXPECT_TRUE(scan.points.empty());
}

TEST(DecodePointCloudTest, RefusesWhatItCannotRead) {
  const auto refuse = [](const std::string& part, void (*spoil)(sensor_msgs::PointCloud2*)) {
    sensor_msgs::PointCloud2 cloud = makeCloud(3, 2);
    spoil(&cloud);
    PointScan scan;
    expectRefusal(DropReason::kBadCloud, part, [&] { decodePointCloud(cloud, 1, &scan); });
  };
  using Cloud = sensor_msgs::PointCloud2;
  refuse("no field z", [](Cloud* cloud) { cloud->fields.pop_back(); });
  refuse("float32",
         [](Cloud* cloud) { cloud->fields[1].datatype = sensor_msgs::PointField::FLOAT64; });
  refuse("point_step", [](Cloud* cloud) { cloud->fields[2].offset = kPointStep - 3; });
  refuse("point_step",
         [](Cloud* cloud) { cloud->fields[0].offset = std::numeric_limits<std::uint32_t>::max(); });
  refuse("row_step", [](Cloud* cloud) { cloud->row_step -= 1; });
  refuse("row_step", [](Cloud* cloud) { cloud->width = 1u << 31; });
  refuse("data", [](Cloud* cloud) { cloud->data.pop_back(); });
  refuse("data", [](Cloud* cloud) { cloud->height = 1u << 31; });
  refuse("byte order", [](Cloud* cloud) { cloud->is_bigendian = !cloud->is_bigendian; });
}

}  // namespace
}  // namespace fiimap
