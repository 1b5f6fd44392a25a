#include "fiimap/ros/scan_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

constexpr double kTimeJump = 1.0;  // s; stamps that go back further mean that time began again
constexpr double kNanoseconds = 1e9;

const std_msgs::Header& headerOf(const ScanMessage& scan) {
  return std::visit([](const auto& message) -> const std_msgs::Header& { return message->header; },
                    scan);
}

/// stamp + offset; zero where that is not a time.
ros::Time shifted(const ros::Time& stamp, double offset) {
  const double max = static_cast<double>(std::numeric_limits<std::uint32_t>::max()) * kNanoseconds;
  const auto offset_ns = static_cast<std::int64_t>(std::llround(offset * kNanoseconds));
  const std::int64_t ns = static_cast<std::int64_t>(stamp.toNSec()) + offset_ns;
  if (ns <= 0 || static_cast<double>(ns) >= max) return ros::Time();
  return ros::Time().fromNSec(static_cast<std::uint64_t>(ns));
}

/// Seconds that passed by both clocks.
double secondsOfBoth(const Moment& from, const Moment& to) {
  const std::chrono::duration<double> steady = to.steady - from.steady;
  return std::min(secondsBetween(from.ros, to.ros), steady.count());
}

}  // namespace

ScanSynchronizer::ScanSynchronizer(const NodeConfig& config, ScanListener* listener)
    : config_(config), listener_(listener), poses_(config) {}

template <typename PoseMessage>
void ScanSynchronizer::addPose(const PoseMessage& pose) {
  const ros::Time& stamp = pose.header.stamp;
  // Poses of another frame are refused, so they must not tell the time either.
  const bool is_ours = plainFrame(pose.header.frame_id) == config_.map_frame;
  if (is_ours && !stamp.isZero()) checkForJump(stamp, poses_.newestPose(), "poses");
  poses_.add(pose);
  emitReadyScans();
}

void ScanSynchronizer::add(const nav_msgs::Odometry& odometry) { addPose(odometry); }
void ScanSynchronizer::add(const geometry_msgs::PoseStamped& pose) { addPose(pose); }
void ScanSynchronizer::add(const geometry_msgs::TransformStamped& pose) { addPose(pose); }

void ScanSynchronizer::addTf(const tf2_msgs::TFMessage& transforms, bool is_static) {
  poses_.addTf(transforms, is_static);
  emitReadyScans();
}

void ScanSynchronizer::add(const sensor_msgs::CameraInfoConstPtr& info) {
  camera_info_ = info;
  warn(camera_check_.look(*info));
  emitReadyScans();
}

void ScanSynchronizer::add(const ScanMessage& scan, const Moment& received) {
  const std_msgs::Header& header = headerOf(scan);
  const ros::Time stamp =
      header.stamp.isZero() ? ros::Time() : shifted(header.stamp, config_.time_offset);
  if (stamp.isZero()) {
    listener_->onDrop({DropReason::kZeroStamp, "a scan has no stamp"});
    return;
  }
  checkForJump(stamp, newest_scan_, "scans");
  if (stamp <= newest_scan_) {
    listener_->onDrop({DropReason::kStaleStamp,
                       "a scan is " + std::to_string(secondsBetween(stamp, newest_scan_)) +
                           " s older than the one before"});
    return;
  }
  newest_scan_ = stamp;
  waiting_.push_back({scan, plainFrame(header.frame_id), stamp, received});
  emitReadyScans();
  if (waiting_.size() > static_cast<std::size_t>(config_.scan_queue_size)) {
    dropFront(whyQueueIsFull(attempt(waiting_.front()).pose.why));
    emitReadyScans();
  }
}

void ScanSynchronizer::checkForJump(const ros::Time& stamp, const ros::Time& newest,
                                    const std::string& what) {
  const double step_back = secondsBetween(stamp, newest);
  if (step_back <= kTimeJump) return;
  restart("the stamps of " + what + " went back by " + std::to_string(step_back) + " s");
}

void ScanSynchronizer::restart(const std::string& why) {
  while (!waiting_.empty()) dropFront({DropReason::kTimeJump, why + " while the scan waited"});
  poses_.clear();
  newest_scan_ = ros::Time();
  listener_->onTimeJump(why);
}

void ScanSynchronizer::emitReadyScans() {
  while (!waiting_.empty()) {
    const WaitingScan& front = waiting_.front();
    const Attempt result = attempt(front);
    if (result.pose.state == ResolvedPose::State::kFound) {
      emitFront(result);
      continue;
    }
    const bool pending = result.pose.state == ResolvedPose::State::kPending;
    const bool waited_long = secondsBetween(front.stamp, newest_scan_) > config_.max_pose_wait;
    if (pending && !waited_long) return;
    dropFront(result.pose.why);
  }
}

void ScanSynchronizer::emitFront(const Attempt& result) {
  const WaitingScan front = std::move(waiting_.front());
  waiting_.pop_front();
  const bool is_image = std::holds_alternative<sensor_msgs::ImageConstPtr>(front.message);
  if (is_image) warn(camera_check_.look(result.pose, front.frame));
  SynchronizedScan scan;
  scan.message = front.message;
  scan.intrinsics = result.intrinsics;
  scan.pose.T_W_S = result.pose.T_W_S;
  scan.pose.vehicle_W = result.pose.T_W_B.translation();
  scan.T_W_B = result.pose.T_W_B;
  scan.pose.stamp_ns = static_cast<std::int64_t>(front.stamp.toNSec());
  scan.pose_gap = result.pose.gap;
  listener_->onScan(scan);
}

void ScanSynchronizer::warn(const std::string& text) {
  if (!text.empty()) listener_->onWarning(text);
}

void ScanSynchronizer::expire(const Moment& now) {
  while (!waiting_.empty() &&
         secondsOfBoth(waiting_.front().received, now) > config_.max_pose_wait) {
    dropFront(attempt(waiting_.front()).pose.why);
    emitReadyScans();
  }
}

void ScanSynchronizer::finish() {
  while (!waiting_.empty()) dropFront(attempt(waiting_.front()).pose.why);
}

void ScanSynchronizer::dropFront(const Drop& drop) {
  waiting_.pop_front();
  listener_->onDrop(drop);
}

ScanSynchronizer::Attempt ScanSynchronizer::attempt(const WaitingScan& waiting) const {
  Attempt result;
  if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&waiting.message)) {
    if (!camera_info_) {
      result.pose.why = {DropReason::kNoCameraInfo, "no camera_info was received"};
      return result;
    }
    try {
      result.intrinsics = decodeCameraInfo(*camera_info_, (*image)->width, (*image)->height);
    } catch (const InputError& error) {
      result.pose.state = ResolvedPose::State::kImpossible;
      result.pose.why = error.drop();
      return result;
    }
  }
  result.pose = poses_.at(waiting.frame, waiting.stamp);
  return result;
}

/// Poses that still come, but late, ask for a longer queue; poses that stopped for another remedy.
Drop ScanSynchronizer::whyQueueIsFull(const Drop& lacking) const {
  const bool poses_come =
      secondsBetween(poses_.newestPose(), newest_scan_) <= config_.max_pose_wait;
  if (lacking.reason != DropReason::kPoseTimeout || !poses_come) return lacking;
  return {DropReason::kQueueFull, std::to_string(config_.scan_queue_size) +
                                      " newer scans wait already and " + lacking.detail};
}

}  // namespace fiimap
