#include "planner_nodelet.h"

#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include "fiimap/ros/parameter_sources.h"
#include "planner_messages.h"

namespace fiimap {
namespace {

constexpr int kQueue = 10;
constexpr double kStepPeriod = 0.02;   // s, of the planning thread
constexpr double kReportPeriod = 0.1;  // s, of status and markers

}  // namespace

void PlannerNodelet::onInit() {
  try {
    configureFromParameters();
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
  const PlannerNodeConfig& node = parameters_.node;
  flight_ = std::make_unique<Flight>(parameters_.planner, parameters_.flight,
                                     [] { return ros::Time::now().toSec(); });
  if (!node.waypoints.empty()) flight_->setGoals(node.waypoints);
  advertise();
  map_ = std::make_unique<MapWatch>(getNodeHandle(), getNodeHandle().resolveName(node.map),
                                    node.map_timeout);
  vehicle_ = std::make_unique<VehicleWatch>(getNodeHandle(), node.odometry_timeout);
  command_ = std::make_unique<CommandThread>(getNodeHandle(), node.command_rate, node.max_yaw_rate);
  goal_subscriber_ = getNodeHandle().subscribe("goal", kQueue, &PlannerNodelet::onGoal, this);
  planning_ = std::make_unique<PeriodicThread>(kStepPeriod, [this] { step(); });
}

PlannerNodelet::~PlannerNodelet() {
  goal_subscriber_.shutdown();
  if (planning_) planning_->stop();
}

void PlannerNodelet::configureFromParameters() {
  const ParameterMap values = parameterMapFromRos(getPrivateNodeHandle());
  for (const std::string& name : configure(values, &parameters_)) {
    NODELET_WARN("parameter %s is unknown and has no effect", name.c_str());
  }
}

void PlannerNodelet::advertise() {
  ros::NodeHandle& node = getPrivateNodeHandle();
  const bool latch = true;
  path_publisher_ = node.advertise<nav_msgs::Path>("path", kQueue, latch);
  trajectory_publisher_ =
      node.advertise<trajectory_msgs::MultiDOFJointTrajectory>("trajectory", kQueue, latch);
  marker_publisher_ = node.advertise<visualization_msgs::MarkerArray>("markers", kQueue);
  status_publisher_ = node.advertise<PlannerStatus>("status", kQueue, latch);
}

void PlannerNodelet::onGoal(const geometry_msgs::PoseStamped::ConstPtr& message) {
  const geometry_msgs::Point& p = message->pose.position;
  Eigen::Vector3d goal(p.x, p.y, p.z);
  const std::string& frame = message->header.frame_id;
  const std::string map_frame = map_->frame();
  if (!goal.allFinite()) {
    NODELET_WARN("a goal was ignored: its position is not finite");
  } else if (!frame.empty() && !map_frame.empty() && frame != map_frame) {
    NODELET_WARN("a goal was ignored: it is in the frame %s, the map in %s", frame.c_str(),
                 map_frame.c_str());
  } else {
    if (goal.z() == 0.0) goal.z() = parameters_.node.goal_height;
    const std::lock_guard<std::mutex> lock(goals_mutex_);
    new_goals_ = {goal};
  }
}

void PlannerNodelet::step() {
  const double time = ros::Time::now().toSec();
  if (time <= 0.0 || time == last_time_) return;  // simulated time stands still
  if (time < last_time_) {
    NODELET_WARN("time jumped back: the flight starts anew");
    flight_->restart();
  }
  last_time_ = time;
  takeGoals();
  const MapWatch::View map = map_->look(time);
  const VehicleWatch::View vehicle = vehicle_->look(time, map_->frame());
  flight_->step({time, map.snapshot, vehicle.state, map.trouble, vehicle.trouble});
  command_->fly(flight_->flown(), vehicle.state.yaw, map_->frame(), vehicle_->bodyFrame());
  report(time);
}

void PlannerNodelet::takeGoals() {
  const std::lock_guard<std::mutex> lock(goals_mutex_);
  if (!new_goals_) return;
  flight_->setGoals(*new_goals_);
  new_goals_.reset();
}

void PlannerNodelet::report(double time) {
  const FlightStatus& status = flight_->status();
  const bool changed = status.state != last_status_.state || status.reason != last_status_.reason;
  if (changed && status.state == FlightState::kBraking) {
    NODELET_WARN("brakes: %s", status.reason.c_str());
  } else if (changed && !status.reason.empty()) {
    NODELET_INFO("%s", status.reason.c_str());
  } else if (changed && status.state == FlightState::kGoalReached) {
    NODELET_INFO("the goal is reached");
  }
  last_status_ = status;
  std_msgs::Header header;
  header.stamp = ros::Time(time);
  header.frame_id = map_->frame();
  publishPlan(time, header);
  const bool due = time - last_report_time_ >= kReportPeriod || time < last_report_time_;
  if (!changed && !due) return;
  last_report_time_ = time;
  status_publisher_.publish(boost::make_shared<const PlannerStatus>(toStatus(status, header)));
  if (marker_publisher_.getNumSubscribers() > 0) {
    marker_publisher_.publish(boost::make_shared<const visualization_msgs::MarkerArray>(
        toMarkers(*flight_, time, header)));
  }
}

void PlannerNodelet::publishPlan(double time, const std_msgs::Header& header) {
  const FlownTrajectory& flown = flight_->flown();
  const std::shared_ptr<const Trajectory>& newest = flown.next ? flown.next : flown.current;
  if (!newest || newest == last_published_ || newest->endTime() <= time) return;
  last_published_ = newest;
  path_publisher_.publish(
      boost::make_shared<const nav_msgs::Path>(toPath(flight_->plan().path, header)));
  trajectory_publisher_.publish(boost::make_shared<const trajectory_msgs::MultiDOFJointTrajectory>(
      toTrajectory(*newest, header, vehicle_->bodyFrame())));
}

}  // namespace fiimap

PLUGINLIB_EXPORT_CLASS(fiimap::PlannerNodelet, nodelet::Nodelet)
