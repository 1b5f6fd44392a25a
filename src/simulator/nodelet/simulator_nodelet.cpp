#include "simulator_nodelet.h"

#include <stdexcept>
#include <string>
#include <utility>

#include <pluginlib/class_list_macros.hpp>

#include "fiimap/ros/parameter_sources.h"
#include "simulator_messages.h"

namespace fiimap::sim {
namespace {

constexpr int kCommandQueue = 10;
constexpr int kFollowerQueue = 10;
constexpr double kWarningPeriod = 5.0;  // s
constexpr double kMaxDelay = 0.1;       // s behind the wall clock, then frames are left out

/// Stamps and clock must be of one kind.
void requireFittingClock(bool publish_clock) {
  if (publish_clock == ros::Time::isSimTime()) return;
  throw std::invalid_argument(
      publish_clock ? "parameter publish_clock = true: needs /use_sim_time = true, set before the "
                      "nodes start"
                    : "parameter publish_clock = false: must be true, because /use_sim_time is "
                      "true");
}

}  // namespace

void SimulatorNodelet::onInit() {
  try {
    configureFromParameters();
    requireFittingClock(config_.publish_clock);
    simulator_ = std::make_unique<Simulator>(config_);
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
  const World& world = simulator_->scene().world();
  NODELET_INFO(
      "world: %zu triangles, %zu moving obstacles; start %.1f %.1f %.1f, goal %.1f %.1f %.1f",
      world.still.triangles.size(), world.moving.size(), world.start_W.x(), world.start_W.y(),
      world.start_W.z(), world.goal_W.x(), world.goal_W.y(), world.goal_W.z());
  const bool catches_up = !config_.publish_clock;
  pacer_ = std::make_unique<Pacer>(config_.real_time_factor, config_.max_lead, catches_up);
  publisher_ =
      std::make_unique<SimulatorPublisher>(getNodeHandle(), getPrivateNodeHandle(), config_, world);
  command_subscriber_ =
      getNodeHandle().subscribe("command", kCommandQueue, &SimulatorNodelet::onCommand, this,
                                ros::TransportHints().tcpNoDelay());
  if (config_.max_lead > 0.0) {
    map_subscriber_ =
        getNodeHandle().subscribe("map_statistics", kFollowerQueue, &SimulatorNodelet::onMap, this);
    // Commands go on while a plan takes its time: they do not tell how far the planner is.
    planner_subscriber_ = getNodeHandle().subscribe("planner_status", kFollowerQueue,
                                                    &SimulatorNodelet::onPlanner, this);
  }
  thread_ = std::thread([this] { run(); });
}

SimulatorNodelet::~SimulatorNodelet() {
  stopping_ = true;
  command_subscriber_.shutdown();
  map_subscriber_.shutdown();
  planner_subscriber_.shutdown();
  if (pacer_) pacer_->stop();
  if (thread_.joinable()) thread_.join();
}

void SimulatorNodelet::configureFromParameters() {
  const ParameterMap values = parameterMapFromRos(getPrivateNodeHandle());
  for (const std::string& name : applyParameters(values, simulatorParameters(&config_))) {
    NODELET_WARN("parameter %s is unknown and has no effect", name.c_str());
  }
  config_.validate();
}

void SimulatorNodelet::onCommand(
    const trajectory_msgs::MultiDOFJointTrajectory::ConstPtr& message) {
  const double time = publisher_->timeOf(message->header.stamp);
  try {
    const Setpoint setpoint = toSetpoint(*message, config_.world_frame);
    const std::lock_guard<std::mutex> lock(command_mutex_);
    command_ = Command{setpoint, time};
  } catch (const std::invalid_argument& error) {
    NODELET_WARN_THROTTLE(kWarningPeriod, "a command was refused: %s", error.what());
    return;
  }
  pacer_->hear(Pacer::Follower::kCommands, time);
}

void SimulatorNodelet::onPlanner(const PlannerStatus::ConstPtr& status) {
  pacer_->hear(Pacer::Follower::kPlanner, publisher_->timeOf(status->header.stamp));
}

void SimulatorNodelet::onMap(const Statistics::ConstPtr& statistics) {
  pacer_->hear(Pacer::Follower::kMap, publisher_->timeOf(statistics->header.stamp));
}

void SimulatorNodelet::run() {
  while (!stopping_) step();
}

void SimulatorNodelet::step() {
  pacer_->waitFor(simulator_->time() + 1.0 / Simulator::kStepsPerSecond);
  if (stopping_) return;
  {
    const std::lock_guard<std::mutex> lock(command_mutex_);
    if (command_) simulator_->command(command_->setpoint, command_->time);
    command_.reset();
  }
  simulator_->advance();
  // Asked before the pose goes out: who subscribes to poses and then to images, meanwhile, would
  // get an image from before its first pose.
  const bool image_is_due = simulator_->cameraIsDue() && publisher_->imageIsWanted();
  const bool cloud_is_due = simulator_->lidarIsDue() && publisher_->cloudIsWanted();
  publisher_->publishState(*simulator_);
  publishSensors(image_is_due, cloud_is_due);
}

void SimulatorNodelet::publishSensors(bool image_is_due, bool cloud_is_due) {
  const bool is_late = !config_.publish_clock && pacer_->delay() > kMaxDelay;
  if (image_is_due) {
    if (is_late) {
      NODELET_WARN_THROTTLE(kWarningPeriod,
                            "the machine is too slow to render every frame: lower camera_rate or "
                            "the image's size, or simulate time with publish_clock");
    } else {
      publisher_->publishImage(simulator_->time(), simulator_->depthImage());
    }
  }
  if (cloud_is_due && !is_late) {
    publisher_->publishCloud(simulator_->time(), simulator_->lidarPoints());
  }
}

}  // namespace fiimap::sim

PLUGINLIB_EXPORT_CLASS(fiimap::sim::SimulatorNodelet, nodelet::Nodelet)
