#include "simulator.h"

#include <gtest/gtest.h>

#include <cstring>

#include "geometry_oracle.h"

namespace fiimap::sim {
namespace {

SimulatorConfig smallConfig() {
  SimulatorConfig config;
  config.world.world = WorldKind::kCorridor;
  config.world.length = 30.0;
  config.camera.image_width = 64;
  config.camera.image_height = 48;
  return config;
}

SimulatorConfig everythingOn() {
  SimulatorConfig config = smallConfig();
  config.world.moving_obstacles = 3;
  config.noise.depth_noise = true;
  config.lidar.lidar = LidarKind::kLivox;
  config.lidar.lidar_noise = 0.01;
  config.odometry.odometry_drift = 0.05;
  config.odometry.odometry_yaw_drift = 0.01;
  config.odometry.odometry_jump = 0.2;
  config.odometry.odometry_jump_period = 0.7;
  config.odometry.odometry_delay = 0.02;
  return config;
}

template <typename Value>
void appendBytes(const Value* values, std::size_t count, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

/// All that a simulator gives away in two seconds of flight.
std::string bytesOfFlight(const SimulatorConfig& config) {
  Simulator simulator(config);
  std::string bytes;
  for (int step = 0; step < 600; ++step) {
    Setpoint setpoint;
    setpoint.position_W = simulator.scene().world().start_W + Eigen::Vector3d(0.005 * step, 0, 0);
    if (step % 5 == 0) simulator.command(setpoint, simulator.time());
    simulator.advance();
    while (const auto odometry = simulator.odometry()) {
      appendBytes(odometry->T_O_B.data(), 16, &bytes);
      appendBytes(odometry->velocity_B.data(), 3, &bytes);
    }
    if (simulator.cameraIsDue()) {
      const auto image = simulator.depthImage();
      appendBytes(image.data(), image.size(), &bytes);
    }
    if (simulator.lidarIsDue()) {
      for (const Eigen::Vector3f& point : simulator.lidarPoints()) {
        appendBytes(point.data(), 3, &bytes);
      }
    }
    appendBytes(&simulator.record().clearance, 1, &bytes);
  }
  return bytes;
}

TEST(SimulatorTest, SameSeedGivesTheSameBytes) {
  SimulatorConfig config = everythingOn();
  const std::string bytes = bytesOfFlight(config);
  EXPECT_GT(bytes.size(), 60u * 64u * 48u * 2u);
  EXPECT_TRUE(bytes == bytesOfFlight(config));
  config.world.seed = 2;
  EXPECT_FALSE(bytes == bytesOfFlight(config));
}

TEST(SimulatorTest, EventsComeAtTheirRates) {
  Simulator simulator(everythingOn());
  int images = 0, scans = 0, poses = 0;
  for (int step = 0; step < 3000; ++step) {
    simulator.advance();
    images += simulator.cameraIsDue();
    scans += simulator.lidarIsDue();
    while (simulator.odometry()) ++poses;
  }
  EXPECT_EQ(images, 300);
  EXPECT_EQ(scans, 100);
  EXPECT_EQ(poses, 998);  // the last two are still on their way
}

TEST(SimulatorTest, HoversUntilTheFirstCommand) {
  Simulator simulator(smallConfig());
  const Eigen::Vector3d start_W = simulator.scene().world().start_W;
  for (int step = 0; step < 600; ++step) simulator.advance();
  EXPECT_LT((simulator.vehicle().position_W - start_W).norm(), 1e-9);
  EXPECT_EQ(simulator.record().path_length, 0.0);
}

TEST(SimulatorTest, FollowsCommandsAndBrakesWhenTheyStop) {
  Simulator simulator(smallConfig());
  const Eigen::Vector3d start_W = simulator.scene().world().start_W;
  constexpr double kSpeed = 1.5;
  Setpoint setpoint;
  setpoint.velocity_W = {kSpeed, 0, 0};
  for (int step = 0; step < 600; ++step) {
    setpoint.position_W = start_W + Eigen::Vector3d(kSpeed * simulator.time(), 0, 0);
    if (step % 6 == 0) simulator.command(setpoint, simulator.time());
    simulator.advance();
  }
  EXPECT_NEAR(simulator.vehicle().position_W.x(), kSpeed * simulator.time(), 0.05);
  EXPECT_NEAR(simulator.vehicle().velocity_W.x(), kSpeed, 0.05);

  // Half a second more on the last command, then it brakes.
  for (int step = 0; step < 140; ++step) simulator.advance();
  EXPECT_NEAR(simulator.vehicle().velocity_W.x(), kSpeed, 0.05);
  for (int step = 0; step < 900; ++step) simulator.advance();
  EXPECT_LT(simulator.vehicle().velocity_W.norm(), 1e-2);
  const double stop = simulator.vehicle().position_W.x();
  EXPECT_LT(stop, kSpeed * 2.5 + 1.0);
  for (int step = 0; step < 600; ++step) simulator.advance();
  EXPECT_NEAR(simulator.vehicle().position_W.x(), stop, 0.05);
  EXPECT_NEAR(simulator.record().path_length, stop, 0.1);
}

TEST(SimulatorTest, ALateCommandHoldsAtItsTime) {
  Simulator late(smallConfig()), punctual(smallConfig());
  constexpr double kDelay = 0.2;  // s
  Setpoint setpoint;
  setpoint.velocity_W = {1, 0, 0};
  for (int step = 0; step < 900; ++step) {
    for (Simulator* simulator : {&late, &punctual}) {
      const double time = simulator->time() - (simulator == &late ? kDelay : 0.0);
      setpoint.position_W = simulator->scene().world().start_W + Eigen::Vector3d(time, 0, 0);
      simulator->command(setpoint, time);
      simulator->advance();
    }
  }
  EXPECT_NEAR(late.vehicle().position_W.x(), punctual.vehicle().position_W.x(), 1e-6);
}

TEST(SimulatorTest, OdometryIsTheTruthWithoutErrors) {
  Simulator simulator(smallConfig());
  Setpoint setpoint;
  setpoint.position_W = simulator.scene().world().start_W + Eigen::Vector3d(1, 1, 0);
  for (int step = 0; step < 100; ++step) {
    simulator.command(setpoint, simulator.time());
    simulator.advance();
    while (const auto odometry = simulator.odometry()) {
      const Eigen::Isometry3d T_W_B = simulator.vehicle().T_W_B();
      EXPECT_EQ(odometry->time, simulator.time());
      EXPECT_TRUE(odometry->T_O_B.isApprox(T_W_B, 1e-12));
      EXPECT_TRUE(
          (T_W_B.linear() * odometry->velocity_B).isApprox(simulator.vehicle().velocity_W, 1e-9));
    }
  }
}

TEST(SimulatorTest, ItsControllerBelievesTheOdometry) {
  SimulatorConfig config = smallConfig();
  config.odometry.odometry_drift = 0.1;
  config.odometry.odometry_yaw_drift = 0.02;
  Simulator simulator(config);
  const Eigen::Vector3d start_W = simulator.scene().world().start_W;
  Setpoint setpoint;
  setpoint.position_W = start_W;
  double estimated_error = 0.0;
  for (int step = 0; step < 3000; ++step) {
    simulator.command(setpoint, simulator.time());
    simulator.advance();
    while (const auto odometry = simulator.odometry()) {
      estimated_error = (odometry->T_O_B.translation() - start_W).norm();
    }
  }
  const double true_error = (simulator.vehicle().position_W - start_W).norm();
  EXPECT_LT(estimated_error, 0.1);
  EXPECT_GT(true_error, 0.1);
}

TEST(SimulatorTest, ClearanceIsTheDistanceToTheGeometry) {
  Random random(41);
  for (const WorldKind kind : {WorldKind::kCorridor, WorldKind::kShelfRoom, WorldKind::kForest}) {
    WorldConfig config;
    config.world = kind;
    config.length = 15.0;
    config.width = 10.0;
    config.moving_obstacles = 4;
    const RayScene scene(makeWorld(config));
    for (int round = 0; round < 30; ++round) {
      const double time = random.uniform(0.0, 60.0);
      const Eigen::Vector3d point_W = test::randomPoint(&random, {-5, -5, 0}, {18, 5, 3});
      const double exact = test::toMesh(point_W, test::meshAt(scene.world(), time));
      EXPECT_NEAR(scene.distance(point_W, time, 100.0), exact, 1e-5) << "seed 41, " << round;
      EXPECT_NEAR(scene.distance(point_W, time, 0.5), std::min(exact, 0.5), 1e-5);
    }
  }
}

TEST(SimulatorTest, CountsACollisionOncePerContact) {
  SimulatorConfig config = smallConfig();
  config.world.world = WorldKind::kMaze;
  config.vehicle_radius = 0.3;
  Simulator simulator(config);
  const Eigen::Vector3d start_W = simulator.scene().world().start_W;
  const auto fly_to = [&](const Eigen::Vector3d& position_W) {
    Setpoint setpoint;
    setpoint.position_W = position_W;
    for (int step = 0; step < 900; ++step) {
      simulator.command(setpoint, simulator.time());
      simulator.advance();
    }
  };
  const Eigen::Vector3d at_wall_W = start_W - Eigen::Vector3d(1.2, 0, 0);  // the wall: at -1.4
  fly_to(at_wall_W);
  EXPECT_EQ(simulator.record().collisions, 1u);
  EXPECT_NEAR(simulator.record().clearance, 0.2, 1e-3);
  fly_to(start_W);
  EXPECT_EQ(simulator.record().collisions, 1u);
  fly_to(at_wall_W);
  EXPECT_EQ(simulator.record().collisions, 2u);
  EXPECT_NEAR(simulator.record().path_length, 3.6, 0.3);  // it overshoots a little
}

}  // namespace
}  // namespace fiimap::sim
