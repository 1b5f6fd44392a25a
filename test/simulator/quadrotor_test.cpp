#include "quadrotor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry_oracle.h"

namespace fiimap::sim {
namespace {

constexpr double kStep = 1.0 / 300.0;  // s

Setpoint randomSetpoint(Random* random) {
  const auto vector = [&](double size) {
    return test::randomPoint(random, Eigen::Vector3d::Constant(-size),
                             Eigen::Vector3d::Constant(size));
  };
  return {vector(50.0), vector(20.0), vector(30.0), random->uniform(-10.0, 10.0)};
}

TEST(QuadrotorTest, KeepsItsLimitsWhateverIsAskedFor) {
  const QuadrotorConfig config;
  // Turning the acceleration round takes 2 a / j at most, with the controller's delay on top.
  const double reaction = 2 * config.max_acceleration / config.max_jerk + 2 / config.attitude_gain;
  const double max_speed = config.max_velocity + config.max_acceleration * reaction;
  Random random(31);
  for (int flight = 0; flight < 50; ++flight) {
    Quadrotor vehicle(config, Eigen::Vector3d::Zero(), 0.0);
    Setpoint setpoint;
    for (int step = 0; step < 3000; ++step) {
      if (random.chance(0.02)) setpoint = randomSetpoint(&random);
      const Quadrotor::State before = vehicle.state();
      if (random.chance(0.1)) {
        vehicle.brake(kStep);
      } else {
        vehicle.advance(setpoint, kStep);
      }
      const Quadrotor::State& after = vehicle.state();
      ASSERT_LE(after.acceleration_W.norm(), config.max_acceleration * (1 + 1e-9));
      ASSERT_LE((after.acceleration_W - before.acceleration_W).norm() / kStep,
                config.max_jerk * (1 + 1e-6));
      ASSERT_LE(std::abs(after.yaw - before.yaw) / kStep, config.max_yaw_rate * (1 + 1e-6));
      ASSERT_LE(after.velocity_W.norm(), max_speed) << "seed 31, flight " << flight;
    }
  }
}

TEST(QuadrotorTest, StateIsConsistent) {
  Random random(32);
  Quadrotor vehicle({}, Eigen::Vector3d::Zero(), 0.0);
  Setpoint setpoint;
  for (int step = 0; step < 3000; ++step) {
    if (random.chance(0.02)) setpoint = randomSetpoint(&random);
    const Quadrotor::State before = vehicle.state();
    vehicle.advance(setpoint, kStep);
    const Quadrotor::State& after = vehicle.state();
    // Trapezoids: exact up to the third order of the step.
    ASSERT_LT(
        (after.position_W - before.position_W - kStep / 2 * (before.velocity_W + after.velocity_W))
            .norm(),
        1e-5);
    ASSERT_LT((after.velocity_W - before.velocity_W -
               kStep / 2 * (before.acceleration_W + after.acceleration_W))
                  .norm(),
              1e-9);
    // Thrust along the body's z explains the acceleration, and the nose points along the yaw.
    const Eigen::Matrix3d R_W_B = after.T_W_B().linear();
    ASSERT_LT((R_W_B * R_W_B.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    ASSERT_NEAR(R_W_B.determinant(), 1.0, 1e-9);
    const Eigen::Vector3d thrust_B =
        R_W_B.transpose() * (after.acceleration_W + Eigen::Vector3d(0, 0, 9.81));
    ASSERT_LT(thrust_B.head<2>().norm(), 1e-9);
    ASSERT_GT(thrust_B.z(), 0.0);
    const Eigen::Vector2d nose = R_W_B.col(0).head<2>();
    ASSERT_NEAR(std::remainder(std::atan2(nose.y(), nose.x()) - after.yaw, 2 * M_PI), 0.0, 1e-9);
  }
}

TEST(QuadrotorTest, ReachesASetpointAndStays) {
  Quadrotor vehicle({}, {1, 2, 3}, 0.5);
  Setpoint setpoint;
  setpoint.position_W = {6, -2, 4};
  setpoint.yaw = -3.0;
  for (int step = 0; step < 3000; ++step) vehicle.advance(setpoint, kStep);
  EXPECT_LT((vehicle.state().position_W - setpoint.position_W).norm(), 1e-3);
  EXPECT_LT(vehicle.state().velocity_W.norm(), 1e-3);
  EXPECT_NEAR(std::remainder(vehicle.state().yaw + 3.0, 2 * M_PI), 0.0, 1e-3);
}

TEST(QuadrotorTest, TracksAFeasibleTrajectory) {
  // A circle at 3 m/s and 4.5 m/s^2.
  constexpr double kRadius = 2.0, kSpeed = 3.0, kRate = kSpeed / kRadius;
  Quadrotor vehicle({}, {kRadius, 0, 1}, 0.0);
  double worst = 0.0;
  for (int step = 1; step < 3000; ++step) {
    const double angle = kRate * step * kStep;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d along(-out.y(), out.x(), 0);
    Setpoint setpoint;
    setpoint.position_W = kRadius * out + Eigen::Vector3d(0, 0, 1);
    setpoint.velocity_W = kSpeed * along;
    setpoint.acceleration_W = -kSpeed * kRate * out;
    vehicle.advance(setpoint, kStep);
    const double error = (vehicle.state().position_W - setpoint.position_W).norm();
    if (step > 900) worst = std::max(worst, error);  // it began at rest
  }
  EXPECT_LT(worst, 0.1);
}

TEST(QuadrotorTest, BrakesToAStandstill) {
  Quadrotor vehicle({}, Eigen::Vector3d::Zero(), 0.3);
  Setpoint setpoint;
  setpoint.position_W = {100, 0, 0};
  setpoint.yaw = 0.3;
  for (int step = 0; step < 900; ++step) vehicle.advance(setpoint, kStep);
  const double speed = vehicle.state().velocity_W.norm();
  EXPECT_GT(speed, 7.0);
  const double from = vehicle.state().position_W.x();
  for (int step = 0; step < 1200; ++step) vehicle.brake(kStep);
  EXPECT_LT(vehicle.state().velocity_W.norm(), 0.01);
  EXPECT_NEAR(vehicle.state().yaw, 0.3, 1e-9);
  // At full deceleration it would take v^2 / 2 a; no more than twice that.
  EXPECT_LT(vehicle.state().position_W.x() - from,
            speed * speed / QuadrotorConfig().max_acceleration);
}

}  // namespace
}  // namespace fiimap::sim
