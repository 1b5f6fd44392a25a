#include "command_thread.h"

#include <algorithm>

#include <boost/make_shared.hpp>

#include "planner_messages.h"

namespace fiimap {
namespace {

constexpr int kCommandQueue = 1;
constexpr double kMaxPeriod = 0.1;  // s; after a longer pause the heading does not catch up

}  // namespace

CommandThread::CommandThread(ros::NodeHandle node, double rate, double max_yaw_rate)
    : heading_(max_yaw_rate),
      publisher_(
          node.advertise<trajectory_msgs::MultiDOFJointTrajectory>("command", kCommandQueue)),
      thread_(1.0 / rate, [this] { publish(); }) {}

CommandThread::~CommandThread() {
  thread_.stop();
  publisher_.shutdown();
}

void CommandThread::fly(const FlownTrajectory& flown, double yaw, const std::string& map_frame,
                        const std::string& body_frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!flown_.current) heading_.reset(yaw);
  flown_ = flown;
  map_frame_ = map_frame;
  body_frame_ = body_frame;
}

void CommandThread::publish() {
  const ros::Time now = ros::Time::now();
  const double time = now.toSec();
  const std::lock_guard<std::mutex> lock(mutex_);
  const double period = std::clamp(time - last_time_, 0.0, kMaxPeriod);
  last_time_ = time;
  if (!flown_.current) return;
  heading_.update(flown_, time, period);
  std_msgs::Header header;
  header.stamp = now;
  header.frame_id = map_frame_;
  publisher_.publish(boost::make_shared<const trajectory_msgs::MultiDOFJointTrajectory>(
      toCommand(flown_.at(time).at(time), heading_.yaw(), heading_.rate(), header, body_frame_)));
}

}  // namespace fiimap
