#include "simulator.h"

#include <algorithm>
#include <cmath>

namespace fiimap::sim {
namespace {

constexpr double kStep = 1.0 / Simulator::kStepsPerSecond;  // s
constexpr double kStandstill = 0.05;                        // m/s: braking ends, hovering begins
constexpr double kFarthestClearance = 100.0;                // m, where the search ends

std::uint64_t seedOf(const SimulatorConfig& config) {
  return static_cast<std::uint64_t>(config.world.seed);
}

World checkedWorld(const SimulatorConfig& config) {
  config.validate();
  return makeWorld(config.world);
}

}  // namespace

Simulator::Simulator(const SimulatorConfig& config)
    : config_(config),
      scene_(checkedWorld(config)),
      vehicle_(config.vehicle, scene_.world().start_W, scene_.world().start_yaw),
      odometry_error_(config.odometry, seedOf(config)),
      camera_(config.camera),
      noise_(config.noise, config.camera.focalLength(), seedOf(config)),
      lidar_(config.lidar, seedOf(config)) {
  hover_W_.position_W = scene_.world().start_W;
  hover_W_.yaw = scene_.world().start_yaw;
  record_.add(measureClearance(), 0.0, config_.vehicle_radius);
}

void Simulator::command(const Setpoint& setpoint_O, double time) {
  setpoint_O_ = setpoint_O;
  setpoint_time_ = std::clamp(time, this->time() - config_.command_timeout, this->time());
  setpoint_step_ = steps_;
}

void Simulator::advance() {
  ++steps_;
  const Eigen::Vector3d before_W = vehicle().position_W;
  fly();
  record_.add(measureClearance(), (vehicle().position_W - before_W).norm(), config_.vehicle_radius);
  odometry_error_.advance(time(), kStep, vehicle().position_W);
  if (odometryIsDue()) {
    const Eigen::Isometry3d T_W_B = vehicle().T_W_B();
    odometry_.push_back({time(), odometry_error_.T_O_W() * T_W_B,
                         T_W_B.linear().transpose() * vehicle().velocity_W, vehicle().yaw_rate});
  }
}

void Simulator::fly() {
  const auto timeout_steps = static_cast<std::uint64_t>(config_.command_timeout * kStepsPerSecond);
  if (setpoint_O_ && steps_ - setpoint_step_ <= timeout_steps) {
    vehicle_.advance(extrapolatedCommand(), kStep);
    return;
  }
  if (setpoint_O_) {  // commands stopped: brake, then hover where that ends
    vehicle_.brake(kStep);
    hover_W_.position_W = vehicle().position_W;
    hover_W_.yaw = vehicle().yaw;
    if (vehicle().velocity_W.norm() < kStandstill) setpoint_O_.reset();
    return;
  }
  vehicle_.advance(hover_W_, kStep);
}

/// The newest command, gone on as it began, in the true world.
Setpoint Simulator::extrapolatedCommand() const {
  const double age = time() - setpoint_time_;
  const Setpoint& c = *setpoint_O_;
  const Eigen::Isometry3d T_W_O = odometry_error_.T_O_W().inverse();
  const Eigen::Vector3d forward_W = T_W_O.linear().col(0);
  Setpoint setpoint;
  setpoint.position_W =
      T_W_O * (c.position_W + age * c.velocity_W + age * age / 2.0 * c.acceleration_W);
  setpoint.velocity_W = T_W_O.linear() * (c.velocity_W + age * c.acceleration_W);
  setpoint.acceleration_W = T_W_O.linear() * c.acceleration_W;
  setpoint.yaw = c.yaw + std::atan2(forward_W.y(), forward_W.x());
  return setpoint;
}

std::optional<OdometrySample> Simulator::odometry() {
  constexpr double kRounding = 1e-9;  // s
  if (odometry_.empty()) return std::nullopt;
  if (odometry_.front().time + config_.odometry.odometry_delay > time() + kRounding) {
    return std::nullopt;
  }
  const OdometrySample sample = odometry_.front();
  odometry_.pop_front();
  return sample;
}

bool Simulator::isDue(double rate) const {
  constexpr double kRounding = 1e-9;  // of an event
  const auto events = [rate](std::uint64_t steps) {
    return std::floor(static_cast<double>(steps) * rate / kStepsPerSecond + kRounding);
  };
  return steps_ > 0 && events(steps_) > events(steps_ - 1);
}

std::vector<std::uint16_t> Simulator::depthImage() {
  scene_.setTime(time());
  const Eigen::Isometry3d T_W_C = vehicle().T_W_B() * config_.camera.T_B_C();
  DepthFrame frame = camera_.render(scene_, T_W_C, config_.noise.depth_noise);
  if (config_.noise.depth_noise) noise_.apply(steps_, &frame);
  return toMillimetres(frame, config_.camera.min_range, config_.camera.max_range);
}

std::vector<Eigen::Vector3f> Simulator::lidarPoints() {
  scene_.setTime(time());
  return lidar_.scan(scene_, vehicle().T_W_B() * config_.lidar.T_B_L(), steps_);
}

double Simulator::measureClearance() const {
  return scene_.distance(vehicle().position_W, time(), kFarthestClearance);
}

}  // namespace fiimap::sim
