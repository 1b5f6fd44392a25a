#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <fiimap/PlannerStatus.h>
#include <fiimap/Statistics.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include "pacer.h"
#include "simulator.h"
#include "simulator_publisher.h"

namespace fiimap::sim {

/// A simulated vehicle as a nodelet: takes commands, and publishes what a real vehicle would and
/// the truth. Simulates and publishes in a thread of its own.
class SimulatorNodelet : public nodelet::Nodelet {
 public:
  SimulatorNodelet() = default;
  /// Stops and joins everything; may be called at any moment.
  ~SimulatorNodelet() override;

 private:
  /// \throws std::exception on a bad configuration, so that loading fails.
  void onInit() override;
  void configureFromParameters();
  void onCommand(const trajectory_msgs::MultiDOFJointTrajectory::ConstPtr& message);
  void onMap(const Statistics::ConstPtr& statistics);
  void onPlanner(const PlannerStatus::ConstPtr& status);

  // On the simulating thread.
  void run();
  void step();
  void publishSensors(bool image_is_due, bool cloud_is_due);

  SimulatorConfig config_;
  std::unique_ptr<Simulator> simulator_;
  std::unique_ptr<SimulatorPublisher> publisher_;
  std::unique_ptr<Pacer> pacer_;

  struct Command {
    Setpoint setpoint;
    double time;  ///< s, of its stamp
  };
  std::mutex command_mutex_;
  std::optional<Command> command_;  // newest that was not yet taken

  std::atomic<bool> stopping_{false};
  ros::Subscriber command_subscriber_;
  ros::Subscriber map_subscriber_;
  ros::Subscriber planner_subscriber_;
  std::thread thread_;
};

}  // namespace fiimap::sim
