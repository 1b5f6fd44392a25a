#include "odometry_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fiimap::sim {
namespace {

constexpr double kOdometryStep = 1.0 / 300.0;  // s

TEST(OdometryErrorTest, IsNothingByDefault) {
  OdometryError error({}, 1);
  for (int i = 1; i < 10000; ++i)
    error.advance(i * kOdometryStep, kOdometryStep, Eigen::Vector3d(i, 0, 0));
  EXPECT_EQ(error.T_O_W().matrix(), Eigen::Matrix4d::Identity());
}

TEST(OdometryErrorTest, DriftsLikeARandomWalk) {
  OdometryConfig config;
  config.odometry_drift = 0.1;
  config.odometry_yaw_drift = 0.02;
  constexpr int kRuns = 400;
  constexpr double kSeconds = 4.0;
  const Eigen::Vector3d position_W(30, 40, 2);
  double shift = 0.0, turn = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    OdometryError error(config, seed);
    for (int i = 1; i <= kSeconds / kOdometryStep; ++i)
      error.advance(i * kOdometryStep, kOdometryStep, position_W);
    // The yaw drifts around the vehicle, so it does not shift it.
    shift += (error.T_O_W() * position_W - position_W).squaredNorm() / 3.0;
    const Eigen::Vector3d forward = error.T_O_W().linear().col(0);
    turn += std::pow(std::atan2(forward.y(), forward.x()), 2);
  }
  // Deviations grow with the square root of time; relative standard errors 2 % and 3.5 %.
  EXPECT_NEAR(std::sqrt(shift / kRuns), 0.1 * std::sqrt(kSeconds), 0.2 * 0.1);
  EXPECT_NEAR(std::sqrt(turn / kRuns), 0.02 * std::sqrt(kSeconds), 0.2 * 0.04);
}

TEST(OdometryErrorTest, JumpsByItsLengthAtItsTimes) {
  OdometryConfig config;
  config.odometry_jump = 0.5;
  config.odometry_jump_period = 2.0;
  OdometryError error(config, 3);
  int jumps = 0;
  for (int i = 1; i <= 9.0 / kOdometryStep; ++i) {
    const Eigen::Vector3d before = error.T_O_W().translation();
    error.advance(i * kOdometryStep, kOdometryStep, Eigen::Vector3d(5, 5, 5));
    const double shift = (error.T_O_W().translation() - before).norm();
    if (shift == 0.0) continue;
    ++jumps;
    EXPECT_NEAR(shift, 0.5, 1e-9);
    EXPECT_NEAR(std::remainder(i * kOdometryStep, 2.0), 0.0, 2 * kOdometryStep);
  }
  EXPECT_EQ(jumps, 4);
}

}  // namespace
}  // namespace fiimap::sim
