#include "heading_control.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

constexpr double kPeriod = 0.01;  // s

FlownTrajectory flown(const Trajectory& trajectory) {
  return {std::make_shared<const Trajectory>(trajectory), nullptr};
}

Trajectory towards(double x, double y) {
  Bspline::Points control;
  for (int i = 0; i < 20; ++i) control.emplace_back(i * x, i * y, 0.0);
  return {{control, 0.2}, 0.0};
}

TEST(HeadingControlTest, LooksAheadNoFasterThanTheLimit) {
  HeadingControl control(1.0);
  control.reset(0.0);
  const FlownTrajectory left = flown(towards(0.0, 0.2));
  double last = 0.0;
  for (double time = 0.0; time < 2.0; time += kPeriod) {
    const double yaw = control.update(left, time, kPeriod);
    EXPECT_LE(std::abs(yaw - last), kPeriod + 1e-9);
    last = yaw;
  }
  EXPECT_NEAR(last, M_PI / 2.0, 1e-6);
}

TEST(HeadingControlTest, TurnsTheShortWayRound) {
  HeadingControl control(1.0);
  control.reset(3.0);
  const double yaw = control.update(flown(Trajectory::hover({0, 0, 0}, 0.0, -3.0)), 1.0, kPeriod);
  EXPECT_GT(yaw, 3.0);
}

TEST(HeadingControlTest, KeepsItsHeadingAtRest) {
  HeadingControl control(1.0);
  control.reset(0.5);
  EXPECT_EQ(control.update(flown(Trajectory::hover({0, 0, 0}, 0.0)), 1.0, kPeriod), 0.5);
}

}  // namespace
}  // namespace fiimap
