#include "fiimap/ros/scan_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/stamps.h"
#include "fiimap/ros/steady_time.h"

namespace fiimap {
namespace {

constexpr double kNanoseconds = 1e9;

const std_msgs::Header& headerOf(const ScanMessage& scan) {
  return std::visit([](const auto& message) -> const std_msgs::Header& { return message->header; },
                    scan);
}

const std_msgs::Header& headerOf(const PoseMessage& pose) {
  return std::visit([](const auto& message) -> const std_msgs::Header& { return message.header; },
                    pose);
}

/// Of a single wrong stamp.
Drop strayStamp(const std::string& what, const ros::Time& newest, const ros::Time& stamp) {
  return {DropReason::kStaleStamp, what + " alone is stamped " +
                                       std::to_string(secondsBetween(newest, stamp)) +
                                       " s after the one before"};
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
  return std::min(secondsBetween(from.ros, to.ros), secondsBetween(from.steady, to.steady));
}

}  // namespace

ScanSynchronizer::ScanSynchronizer(const NodeConfig& config, ScanListener* listener)
    : config_(config), listener_(listener), poses_(config) {}

void ScanSynchronizer::add(const PoseMessage& pose) {
  const std_msgs::Header& header = headerOf(pose);
  // Poses of another frame are refused, so they must not tell the time either.
  const bool tells_time =
      plainFrame(header.frame_id) == config_.map_frame && !header.stamp.isZero();
  const StampVerdict verdict =
      tells_time ? pose_guard_.judge(header.stamp, newest_scan_) : StampVerdict::kGood;
  const auto use = [this](const auto& message) { poses_.add(message); };
  switch (verdict) {
    case StampVerdict::kDoubtful:
      refuseDoubtfulPose();
      doubtful_pose_ = pose;
      return;
    case StampVerdict::kJumpBack:
      restart(pose_guard_.newest(), header.stamp, "poses");
      add(pose);
      return;
    case StampVerdict::kLeap:
      if (doubtful_pose_) std::visit(use, *doubtful_pose_);
      doubtful_pose_.reset();
      break;
    case StampVerdict::kGood:
      if (tells_time) refuseDoubtfulPose();
  }
  std::visit(use, pose);
  emitReadyScans();
}

void ScanSynchronizer::refuseDoubtfulPose() {
  if (!doubtful_pose_) return;
  poses_.refuse(strayStamp("a pose", pose_guard_.newest(), headerOf(*doubtful_pose_).stamp));
  doubtful_pose_.reset();
}

void ScanSynchronizer::addTf(const tf2_msgs::TFMessage& transforms, bool is_static) {
  poses_.addTf(transforms, is_static, newest_scan_);
  emitReadyScans();
}

void ScanSynchronizer::add(const sensor_msgs::CameraInfoConstPtr& info) {
  camera_info_ = info;
  warn(camera_check_.look(*info));
  emitReadyScans();
}

void ScanSynchronizer::add(const ScanMessage& scan, const Moment& received) {
  const std_msgs::Header& header = headerOf(scan);
  if (header.stamp.isZero()) {
    listener_->onDrop({DropReason::kZeroStamp, "a scan has no stamp"});
    return;
  }
  const ros::Time stamp = shifted(header.stamp, config_.time_offset);
  if (stamp.isZero()) {
    listener_->onDrop(
        {DropReason::kZeroStamp,
         "a scan's stamp of " + std::to_string(header.stamp.toSec()) + " s is no time"});
    return;
  }
  add(WaitingScan{scan, plainFrame(header.frame_id), stamp, received});
}

void ScanSynchronizer::add(const WaitingScan& scan) {
  switch (scan_guard_.judge(scan.stamp, poses_.newestPose())) {
    case StampVerdict::kDoubtful:
      dropDoubtfulScan();
      doubtful_scan_ = scan;
      return;
    case StampVerdict::kJumpBack:
      restart(scan_guard_.newest(), scan.stamp, "scans");
      add(scan);
      return;
    case StampVerdict::kLeap:
      if (doubtful_scan_) enqueue(*std::exchange(doubtful_scan_, std::nullopt));
      break;
    case StampVerdict::kGood:
      dropDoubtfulScan();
  }
  enqueue(scan);
}

void ScanSynchronizer::dropDoubtfulScan() {
  if (!doubtful_scan_) return;
  const ros::Time stamp = std::exchange(doubtful_scan_, std::nullopt)->stamp;
  listener_->onDrop(strayStamp("a scan", newest_scan_, stamp));
}

void ScanSynchronizer::enqueue(const WaitingScan& scan) {
  if (scan.stamp <= newest_scan_) {
    listener_->onDrop({DropReason::kStaleStamp,
                       "a scan is " + std::to_string(secondsBetween(scan.stamp, newest_scan_)) +
                           " s older than the one before"});
    return;
  }
  newest_scan_ = scan.stamp;
  waiting_.push_back(scan);
  emitReadyScans();
  if (waiting_.size() > static_cast<std::size_t>(config_.scan_queue_size)) {
    dropFront(whyQueueIsFull(attempt(waiting_.front()).pose.why));
    emitReadyScans();
  }
}

void ScanSynchronizer::restart(const ros::Time& newest, const ros::Time& stamp,
                               const std::string& what) {
  restart("the stamps of " + what + " went back by " +
          std::to_string(secondsBetween(stamp, newest)) + " s");
}

void ScanSynchronizer::restart(const std::string& why) {
  // Doubtful messages that are older than the others belong to the new time.
  if (doubtful_scan_ && doubtful_scan_->stamp > scan_guard_.newest()) dropDoubtfulScan();
  if (doubtful_pose_ && headerOf(*doubtful_pose_).stamp > pose_guard_.newest()) {
    refuseDoubtfulPose();
  }
  const auto scan = std::exchange(doubtful_scan_, std::nullopt);
  const auto pose = std::exchange(doubtful_pose_, std::nullopt);
  while (!waiting_.empty()) dropFront({DropReason::kTimeJump, why + " while the scan waited"});
  poses_.clear();
  scan_guard_.clear();
  pose_guard_.clear();
  newest_scan_ = ros::Time();
  listener_->onTimeJump(why);
  if (pose) add(*pose);
  if (scan) add(*scan);
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
  if (doubtful_scan_ && secondsOfBoth(doubtful_scan_->received, now) > config_.max_pose_wait) {
    dropDoubtfulScan();
  }
}

void ScanSynchronizer::finish() {
  dropDoubtfulScan();
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
