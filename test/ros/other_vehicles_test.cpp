#include "fiimap/ros/other_vehicles.h"

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

OtherVehicles oneVehicle() {
  OtherVehicles message;
  message.header.frame_id = "map";
  message.header.stamp = ros::Time(100, 500000000);
  message.vehicles.resize(1);
  message.vehicles[0].position.x = 1.0;
  message.vehicles[0].position.z = -3.0;
  message.vehicles[0].radius = 0.5;
  message.vehicles[0].lifetime = ros::Duration(0.25);
  return message;
}

std::string refusal(const std::function<void(OtherVehicles*)>& spoil) {
  OtherVehicles message = oneVehicle();
  spoil(&message);
  try {
    toIgnoredSpheres(message, "map");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(OtherVehiclesTest, AreSpheresOfTheMap) {
  OtherVehicles message = oneVehicle();
  message.vehicles.push_back(message.vehicles[0]);
  message.vehicles[1].radius = 2.0;
  const std::vector<IgnoredSphere> spheres = toIgnoredSpheres(message, "map");
  ASSERT_EQ(spheres.size(), 2u);
  EXPECT_EQ(spheres[0].center_W, Eigen::Vector3d(1.0, 0.0, -3.0));
  EXPECT_EQ(spheres[0].radius, 0.5);
  EXPECT_EQ(spheres[0].stamp_ns, 100500000000);
  EXPECT_EQ(spheres[0].lifetime_ns, 250000000);
  EXPECT_EQ(spheres[1].radius, 2.0);
  message.header.frame_id = "/map";
  message.vehicles.clear();
  EXPECT_TRUE(toIgnoredSpheres(message, "map").empty());
}

TEST(OtherVehiclesTest, BadOnesAreRefusedWithTheReason) {
  EXPECT_EQ(refusal([](OtherVehicles*) {}), "");
  EXPECT_NE(refusal([](OtherVehicles* m) {
              m->header.frame_id = "odom";
            }).find("in frame 'odom', map_frame is 'map'"),
            std::string::npos);
  EXPECT_NE(refusal([](OtherVehicles* m) { m->header.stamp = ros::Time(); }).find("no stamp"),
            std::string::npos);
  for (const double bad : {0.0, -1.0, 101.0, std::nan("")}) {
    EXPECT_NE(refusal([=](OtherVehicles* m) { m->vehicles[0].radius = bad; }).find("radius = "),
              std::string::npos)
        << bad;
  }
  for (const double bad : {0.0, -1.0, 61.0}) {
    EXPECT_NE(refusal([=](OtherVehicles* m) {
                m->vehicles[0].lifetime = ros::Duration(bad);
              }).find("lifetime = "),
              std::string::npos)
        << bad;
  }
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300}) {
    EXPECT_NE(refusal([=](OtherVehicles* m) { m->vehicles[0].position.y = bad; }).find("position"),
              std::string::npos)
        << bad;
  }
}

}  // namespace
}  // namespace fiimap
