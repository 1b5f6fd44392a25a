#include "fiimap/ros/vehicle_path.h"

#include <gtest/gtest.h>

namespace fiimap {
namespace {

constexpr double kStep = 0.03;  // m

geometry_msgs::PoseStamped poseAt(double x) {
  geometry_msgs::PoseStamped pose;
  pose.pose.position.x = x;
  pose.pose.orientation.w = 1.0;
  return pose;
}

double xOf(const VehiclePath& path, std::size_t i) { return path.poses()[i].pose.position.x; }

TEST(VehiclePathTest, KeepsTheNewestPoseAndThoseBeforeItSomeDistanceApart) {
  VehiclePath path;
  for (int i = 0; i < 100; ++i) {
    path.add(poseAt(i * kStep));
    ASSERT_EQ(xOf(path, path.poses().size() - 1), i * kStep);
    ASSERT_EQ(xOf(path, 0), 0.0);
    for (std::size_t k = 1; k + 1 < path.poses().size(); ++k) {
      const double gap = xOf(path, k) - xOf(path, k - 1);
      ASSERT_GE(gap, VehiclePath::kSpacing);
      ASSERT_LT(gap, VehiclePath::kSpacing + kStep);
    }
  }
}

TEST(VehiclePathTest, DoesNotGrowWhereTheVehicleStands) {
  VehiclePath path;
  for (int i = 0; i < 100; ++i) path.add(poseAt(1.0));
  EXPECT_LE(path.poses().size(), 2u);
}

TEST(VehiclePathTest, IsBoundedAndStillShowsTheWholeWay) {
  VehiclePath path;
  const double length = 10.0 * VehiclePath::kMaxPoses * VehiclePath::kSpacing;
  double x = 0.0;
  for (; x < length; x += kStep) {
    path.add(poseAt(x));
    ASSERT_LE(path.poses().size(), VehiclePath::kMaxPoses);
  }
  EXPECT_EQ(xOf(path, 0), 0.0);
  EXPECT_NEAR(xOf(path, path.poses().size() - 1), length, 2 * kStep);
  EXPECT_GT(path.poses().size(), VehiclePath::kMaxPoses / 3);
  double largest_gap = 0.0;
  for (std::size_t i = 1; i < path.poses().size(); ++i) {
    largest_gap = std::max(largest_gap, xOf(path, i) - xOf(path, i - 1));
  }
  EXPECT_LT(largest_gap, length / (VehiclePath::kMaxPoses / 4));
}

TEST(VehiclePathTest, LeavesOutWhatIsOlderThanTheNewest) {
  VehiclePath path;
  for (const double seconds : {5.0, 6.0, 5.5, 7.0}) {
    geometry_msgs::PoseStamped pose = poseAt(seconds);
    pose.header.stamp = ros::Time(seconds);
    path.add(pose);
  }
  ASSERT_EQ(path.poses().size(), 3u);
  for (std::size_t i = 0; i < path.poses().size(); ++i) EXPECT_EQ(xOf(path, i), 5.0 + i);
  path.clear();
  path.add(poseAt(1.0));
  EXPECT_EQ(path.poses().size(), 1u) << "time began again";
}

TEST(VehiclePathTest, BeginsAnewAfterClear) {
  VehiclePath path;
  for (int i = 0; i < 10; ++i) path.add(poseAt(i));
  path.clear();
  EXPECT_TRUE(path.poses().empty());
  path.add(poseAt(5.0));
  EXPECT_EQ(path.poses().size(), 1u);
}

}  // namespace
}  // namespace fiimap
