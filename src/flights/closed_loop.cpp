#include "closed_loop.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>

#include "baselines/thread_clock.h"
#include "fiimap/mapper.h"
#include "heading_control.h"
#include "simulator.h"

namespace fiimap {
namespace {

constexpr double kNoPathPatience = 10.0;  // s; the planner tries again
constexpr double kMicroseconds = 1e-6;    // s

/// Adds the CPU time of a call to a sum, s.
template <typename Call>
void addCpuTime(double* sum, Call&& call) {
  *sum += kMicroseconds * bench::microsecondsOf(call);
}

/// A depth image that waits for the odometry of its moment.
struct WaitingImage {
  double time;
  std::vector<std::uint16_t> depth;
};

class ClosedLoop {
 public:
  explicit ClosedLoop(const FlightSettings& settings)
      : settings_(settings),
        simulator_(settings.simulator),
        mapper_(settings.map),
        flight_(settings.planner.planner, settings.planner.flight,
                [this] { return simulator_.time(); }),
        heading_(settings.planner.node.max_yaw_rate),
        T_B_C_(settings.simulator.camera.T_B_C()) {
    flight_.setGoals({simulator_.scene().world().goal_W});
  }

  FlightOutcome fly() {
    while (!isOver()) step();
    outcome_.reached = flight_.status().state == FlightState::kGoalReached;
    outcome_.seconds = simulator_.time();
    outcome_.truth = simulator_.record();
    outcome_.planner = flight_.status();
    return outcome_;
  }

 private:
  bool isOver() const {
    const bool stuck = simulator_.time() - path_known_ > kNoPathPatience;
    return flight_.status().state == FlightState::kGoalReached || stuck ||
           simulator_.time() > settings_.time_limit;
  }

  void step() {
    CpuTimes* cpu = &outcome_.cpu_s;
    addCpuTime(&cpu->simulation, [this] { simulate(); });
    while (hasOdometryOfNextImage()) addCpuTime(&cpu->mapping, [this] { integrate(); });
    if (snapshot_ && simulator_.isDue(settings_.planner.node.command_rate)) {
      addCpuTime(&cpu->planning, [this] { plan(); });
    }
  }

  void simulate() {
    simulator_.advance();
    if (simulator_.isDue(kClearanceRate)) {
      outcome_.clearances_m.push_back(simulator_.record().clearance);
    }
    if (simulator_.cameraIsDue()) images_.push_back({simulator_.time(), simulator_.depthImage()});
    if (const auto odometry = simulator_.odometry()) {
      vehicle_ = *odometry;
      has_odometry_ = true;
    }
  }

  bool hasOdometryOfNextImage() const {
    return has_odometry_ && !images_.empty() && images_.front().time <= vehicle_.time;
  }

  /// The oldest waiting image.
  void integrate() {
    const sim::CameraConfig& camera = settings_.simulator.camera;
    const std::vector<std::uint16_t>& depth = images_.front().depth;
    DepthImage image;
    image.data = depth.data();
    image.width = camera.image_width;
    image.height = camera.image_height;
    image.row_bytes = camera.image_width * sizeof(depth[0]);
    const double focal_length = camera.focalLength();
    ScanPose pose;
    pose.T_W_S = vehicle_.T_O_B * T_B_C_;
    pose.vehicle_W = vehicle_.T_O_B.translation();
    pose.R_W_B = vehicle_.T_O_B.linear();
    pose.stamp_ns = static_cast<std::int64_t>(std::llround(images_.front().time * 1e9));
    const ScanReport report = mapper_.integrate(
        image, {focal_length, focal_length, camera.center().x(), camera.center().y()}, pose);
    snapshot_ = mapper_.snapshot();
    outcome_.update_ms.push_back(report.times_ms.total());
    images_.pop_front();
  }

  void plan() {
    const double time = simulator_.time();
    FlightInput input;
    input.time = time;
    input.snapshot = snapshot_;
    input.vehicle = vehicleState();
    const std::uint64_t attempts = flight_.status().plans + flight_.status().failures;
    const auto start = std::chrono::steady_clock::now();
    flight_.step(input);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    const FlightStatus& status = flight_.status();
    if (status.plans + status.failures > attempts) outcome_.planning_ms.push_back(taken.count());
    if (status.state != FlightState::kNoPath) path_known_ = time;
    if (flight_.flown().current) {
      command(time);
    } else {
      heading_.reset(input.vehicle.yaw);
    }
  }

  void command(double time) {
    heading_.update(flight_.flown(), time, 1.0 / settings_.planner.node.command_rate);
    const MotionState motion = flight_.flown().at(time).at(time);
    simulator_.command({motion.position, motion.velocity, motion.acceleration, heading_.yaw()},
                       time);
  }

  VehicleState vehicleState() const {
    VehicleState state;
    state.position = vehicle_.T_O_B.translation();
    state.velocity = vehicle_.T_O_B.linear() * vehicle_.velocity_B;
    const Eigen::Vector3d forward_O = vehicle_.T_O_B.linear() * Eigen::Vector3d::UnitX();
    state.yaw = std::atan2(forward_O.y(), forward_O.x());
    return state;
  }

  const FlightSettings& settings_;
  sim::Simulator simulator_;
  Mapper mapper_;
  Flight flight_;
  HeadingControl heading_;
  Eigen::Isometry3d T_B_C_;
  std::deque<WaitingImage> images_;
  sim::OdometrySample vehicle_;
  bool has_odometry_ = false;
  std::shared_ptr<const Snapshot> snapshot_;
  double path_known_ = 0.0;  // s, when there last was a path
  FlightOutcome outcome_;
};

}  // namespace

FlightOutcome flyClosedLoop(const FlightSettings& settings) {
  validate(settings);
  FlightSettings exact = settings;
  // Odometry at every step, so that each image has one of its moment.
  exact.simulator.odometry.odometry_rate = sim::Simulator::kStepsPerSecond;
  return ClosedLoop(exact).fly();
}

}  // namespace fiimap
