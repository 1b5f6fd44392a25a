#include "fiimap/ros/pose_history.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "messages.h"

namespace fiimap {
namespace {

constexpr double kHistory = 5.0;
constexpr double kMaxGap = 0.1;
constexpr double kTolerance = 1e-6;

class PoseHistoryTest : public testing::Test {
 protected:
  double xAt(double seconds) const { return history_.at(at(seconds)).T_W_B.translation().x(); }
  PoseLookup lookup(double seconds) const { return history_.at(at(seconds)).lookup; }

  PoseHistory history_{kHistory, kMaxGap};
};

TEST_F(PoseHistoryTest, WaitsWhileItIsEmpty) {
  EXPECT_TRUE(history_.empty());
  EXPECT_EQ(lookup(0.0), PoseLookup::kNotYet);
}

TEST_F(PoseHistoryTest, InterpolatesPositionLinearlyAndOrientationBySlerp) {
  history_.add(transformAt(1.00, 2.0, 0.2));
  history_.add(transformAt(1.08, 4.0, 0.6));
  const PoseAtStamp pose = history_.at(at(1.02));
  ASSERT_EQ(pose.lookup, PoseLookup::kFound);
  EXPECT_NEAR(pose.T_W_B.translation().x(), 2.5, kTolerance);
  EXPECT_NEAR(std::atan2(pose.T_W_B(1, 0), pose.T_W_B(0, 0)), 0.3, kTolerance);
  EXPECT_NEAR(pose.gap, 0.08, kTolerance);
  EXPECT_EQ(pose.body_frame, "body");
}

TEST_F(PoseHistoryTest, TakesTheShorterWayBetweenOppositeQuaternionSigns) {
  geometry_msgs::TransformStamped second = transformAt(0.05, 0.0, 0.4);
  for (double* q : {&second.transform.rotation.z, &second.transform.rotation.w}) *q = -*q;
  history_.add(transformAt(0.0, 0.0, 0.2));
  history_.add(second);
  const Eigen::Isometry3d T_W_B = history_.at(at(0.025)).T_W_B;
  EXPECT_NEAR(std::atan2(T_W_B(1, 0), T_W_B(0, 0)), 0.3, kTolerance);
}

TEST_F(PoseHistoryTest, NeedsOnePoseOnlyAtItsOwnStamp) {
  history_.add(transformAt(1.0, 7.0));
  EXPECT_EQ(lookup(1.0), PoseLookup::kFound);
  EXPECT_DOUBLE_EQ(xAt(1.0), 7.0);
  EXPECT_DOUBLE_EQ(history_.at(at(1.0)).gap, 0.0);
  EXPECT_EQ(lookup(0.999), PoseLookup::kTooOld);
  EXPECT_EQ(lookup(1.001), PoseLookup::kNotYet);
}

TEST_F(PoseHistoryTest, SortsPosesThatComeOutOfOrder) {
  for (const double seconds : {0.0, 0.10, 0.05, 0.15}) history_.add(transformAt(seconds, seconds));
  EXPECT_NEAR(xAt(0.07), 0.07, kTolerance);
  EXPECT_NEAR(history_.at(at(0.07)).gap, 0.05, kTolerance);
}

TEST_F(PoseHistoryTest, TakesDuplicates) {
  for (const double seconds : {0.0, 0.05, 0.05, 0.05, 0.10}) {
    history_.add(transformAt(seconds, seconds));
  }
  EXPECT_NEAR(xAt(0.05), 0.05, kTolerance);
  EXPECT_NEAR(xAt(0.06), 0.06, kTolerance);
  EXPECT_NEAR(xAt(0.04), 0.04, kTolerance);
}

TEST_F(PoseHistoryTest, RefusesToInterpolateOverAGap) {
  history_.add(transformAt(0.0, 0.0));
  history_.add(transformAt(0.11, 1.0));
  EXPECT_EQ(lookup(0.05), PoseLookup::kGap);
  EXPECT_NEAR(history_.at(at(0.05)).gap, 0.11, kTolerance);
  EXPECT_EQ(lookup(0.11), PoseLookup::kFound);
}

TEST_F(PoseHistoryTest, ForgetsWhatIsOlderThanItsHistory) {
  for (int i = 0; i <= 60; ++i) history_.add(transformAt(0.1 * i, i));
  EXPECT_EQ(lookup(0.95), PoseLookup::kTooOld);
  EXPECT_EQ(lookup(1.05), PoseLookup::kFound);
}

TEST_F(PoseHistoryTest, RefusesBadPosesAndKeepsTheOthers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  history_.add(transformAt(0.0, 1.0));
  expectRefusal(DropReason::kBadPose, "finite", [&] { history_.add(transformAt(0.01, nan)); });
  expectRefusal(DropReason::kBadPose, "finite", [&] { history_.add(transformAt(0.01, 0.0, nan)); });
  geometry_msgs::TransformStamped zero = transformAt(0.01, 0.0);
  zero.transform.rotation.w = 0.0;
  expectRefusal(DropReason::kBadPose, "norm", [&] { history_.add(zero); });
  geometry_msgs::TransformStamped stampless = transformAt(0.01, 0.0);
  stampless.header.stamp = ros::Time();
  expectRefusal(DropReason::kZeroStamp, "stamp", [&] { history_.add(stampless); });
  history_.add(transformAt(0.02, 3.0));
  EXPECT_NEAR(xAt(0.01), 2.0, kTolerance);
}

TEST_F(PoseHistoryTest, NormalisesSlightlyWrongQuaternions) {
  geometry_msgs::TransformStamped pose = transformAt(0.0, 0.0);
  pose.transform.rotation.w = 1.02;
  history_.add(pose);
  EXPECT_TRUE(history_.at(at(0.0)).T_W_B.linear().isIdentity(kTolerance));
}

TEST_F(PoseHistoryTest, SurvivesStampsDecadesApart) {
  history_.add(transformAt(0.0, 0.0));
  geometry_msgs::TransformStamped future = transformAt(0.0, 1.0);
  future.header.stamp = ros::Time(4000000000u, 0);
  history_.add(future);
  EXPECT_EQ(lookup(1.0), PoseLookup::kTooOld);
}

TEST_F(PoseHistoryTest, ClearForgetsEverything) {
  history_.add(transformAt(0.0, 0.0));
  history_.clear();
  EXPECT_TRUE(history_.empty());
  EXPECT_EQ(lookup(0.0), PoseLookup::kNotYet);
}

}  // namespace
}  // namespace fiimap
