#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include "command_thread.h"
#include "flight.h"
#include "map_watch.h"
#include "periodic_thread.h"
#include "vehicle_watch.h"

namespace fiimap {

/// An example planner as a nodelet: goals and odometry in, commands out, on the map of a mapping
/// nodelet in the same manager. Callbacks only store; a thread of its own plans, another one
/// publishes commands.
class PlannerNodelet : public nodelet::Nodelet {
 public:
  PlannerNodelet() = default;
  /// Stops and joins everything; may be called at any moment.
  ~PlannerNodelet() override;

 private:
  /// \throws std::invalid_argument on a bad configuration, so that loading fails.
  void onInit() override;
  void configureFromParameters();
  void advertise();
  void onGoal(const geometry_msgs::PoseStamped::ConstPtr& message);

  // On the planning thread.
  void step();
  void takeGoals();
  void report(double time);
  void publishPlan(double time, const std_msgs::Header& header);

  PlannerParameters parameters_;
  std::mutex goals_mutex_;
  std::optional<std::vector<Eigen::Vector3d>> new_goals_;

  std::unique_ptr<Flight> flight_;
  double last_time_ = 0.0;         ///< of a step, s
  double last_report_time_ = 0.0;  ///< s
  FlightStatus last_status_;
  std::shared_ptr<const Trajectory> last_published_;

  ros::Publisher path_publisher_, trajectory_publisher_, marker_publisher_, status_publisher_;
  ros::Subscriber goal_subscriber_;
  std::unique_ptr<MapWatch> map_;
  std::unique_ptr<VehicleWatch> vehicle_;
  std::unique_ptr<CommandThread> command_;
  std::unique_ptr<PeriodicThread> planning_;
};

}  // namespace fiimap
