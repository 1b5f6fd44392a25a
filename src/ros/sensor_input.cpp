#include "fiimap/ros/sensor_input.h"

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

SensorInput::SensorInput(const NodeConfig& config, std::size_t index, const PoseResolver* poses,
                         ScanListener* listener)
    : config_(config.allSensors().at(index)),
      max_pose_wait_(config.max_pose_wait),
      queue_size_(static_cast<std::size_t>(config.scan_queue_size)),
      index_(index),
      poses_(poses),
      listener_(listener) {}

void SensorInput::reconfigure(const NodeConfig& config) {
  const double time_offset = config_.time_offset;
  config_ = config.allSensors().at(index_);
  max_pose_wait_ = config.max_pose_wait;
  if (config_.time_offset == time_offset) return;
  // Stamps of the old offset say nothing of the order of those to come.
  dropDoubtful();
  guard_.clear();
  newest_ = ros::Time();
}

void SensorInput::add(const sensor_msgs::CameraInfoConstPtr& info) {
  camera_info_ = info;
  warn(camera_check_.look(*info));
}

std::optional<SensorInput::Scan> SensorInput::stamped(const ScanMessage& message,
                                                      const Moment& received) {
  const std_msgs::Header& header = headerOf(message);
  if (header.stamp.isZero()) {
    drop({DropReason::kZeroStamp, "a scan has no stamp"});
    return std::nullopt;
  }
  const ros::Time stamp = shifted(header.stamp, config_.time_offset);
  if (stamp.isZero()) {
    drop({DropReason::kZeroStamp,
          "a scan's stamp of " + std::to_string(header.stamp.toSec()) + " s is no time"});
    return std::nullopt;
  }
  return Scan{message, plainFrame(header.frame_id), stamp, received};
}

bool SensorInput::add(const Scan& scan, const ros::Time& others) {
  switch (guard_.judge(scan.stamp, std::max(poses_->newestPose(), others))) {
    case StampVerdict::kDoubtful:
      dropDoubtful();
      doubtful_ = scan;
      return true;
    case StampVerdict::kJumpBack:
      return false;
    case StampVerdict::kLeap:
      if (doubtful_) enqueue(*std::exchange(doubtful_, std::nullopt));
      break;
    case StampVerdict::kGood:
      dropDoubtful();
  }
  enqueue(scan);
  return true;
}

void SensorInput::enqueue(const Scan& scan) {
  if (scan.stamp <= newest_) {
    drop({DropReason::kStaleStamp, "a scan is " +
                                       std::to_string(secondsBetween(scan.stamp, newest_)) +
                                       " s older than the one before"});
    return;
  }
  newest_ = scan.stamp;
  waiting_.push_back(scan);
}

std::optional<SensorInput::Match> SensorInput::matchFront() {
  while (!waiting_.empty()) {
    const Match found = match(waiting_.front());
    if (found.pose.state == ResolvedPose::State::kFound) return found;
    const bool pending = found.pose.state == ResolvedPose::State::kPending;
    const bool waited_long = secondsBetween(waiting_.front().stamp, newest_) > max_pose_wait_;
    if (pending && !waited_long) return std::nullopt;
    dropFront(found.pose.why);
  }
  return std::nullopt;
}

SynchronizedScan SensorInput::takeFront(const Match& match) {
  const Scan front = std::move(waiting_.front());
  waiting_.pop_front();
  const bool is_image = std::holds_alternative<sensor_msgs::ImageConstPtr>(front.message);
  if (is_image) warn(camera_check_.look(match.pose, front.frame));
  SynchronizedScan scan;
  scan.sensor = index_;
  scan.message = front.message;
  scan.intrinsics = match.intrinsics;
  scan.pose.T_W_S = match.pose.T_W_S;
  scan.pose.vehicle_W = match.pose.T_W_B.translation();
  scan.pose.R_W_B = match.pose.T_W_B.linear();
  scan.T_W_B = match.pose.T_W_B;
  scan.pose.stamp_ns = static_cast<std::int64_t>(front.stamp.toNSec());
  scan.pose_gap = match.pose.gap;
  return scan;
}

bool SensorInput::dropExcess() {
  if (waiting_.size() <= queue_size_) return false;
  dropFront(whyQueueIsFull(match(waiting_.front()).pose.why));
  return true;
}

bool SensorInput::waitsLong(const Scan& scan, const Moment& now) const {
  return secondsOfBoth(scan.received, now) > max_pose_wait_;
}

bool SensorInput::expireFront(const Moment& now) {
  if (doubtful_ && waitsLong(*doubtful_, now)) dropDoubtful();
  if (waiting_.empty() || !waitsLong(waiting_.front(), now)) return false;
  dropFront(match(waiting_.front()).pose.why);
  return true;
}

void SensorInput::finish() {
  dropDoubtful();
  while (!waiting_.empty()) dropFront(match(waiting_.front()).pose.why);
}

std::optional<SensorInput::Scan> SensorInput::restart(const std::string& why) {
  // A doubtful scan that is older than the others belongs to the new time.
  if (doubtful_ && doubtful_->stamp > guard_.newest()) dropDoubtful();
  while (!waiting_.empty()) dropFront({DropReason::kTimeJump, why + " while the scan waited"});
  guard_.clear();
  newest_ = ros::Time();
  return std::exchange(doubtful_, std::nullopt);
}

void SensorInput::drop(const Drop& drop) const { listener_->onDrop(drop, index_); }

void SensorInput::dropDoubtful() {
  if (!doubtful_) return;
  const ros::Time stamp = std::exchange(doubtful_, std::nullopt)->stamp;
  drop(strayStamp("a scan", newest_, stamp));
}

void SensorInput::dropFront(const Drop& drop) {
  waiting_.pop_front();
  this->drop(drop);
}

SensorInput::Match SensorInput::match(const Scan& scan) const {
  Match result;
  if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&scan.message)) {
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
  result.pose = poses_->at(config_, scan.frame, scan.stamp);
  return result;
}

/// Poses that still come, but late, ask for a longer queue; poses that stopped for another remedy.
Drop SensorInput::whyQueueIsFull(const Drop& lacking) const {
  const bool poses_come = secondsBetween(poses_->newestPose(), newest_) <= max_pose_wait_;
  if (lacking.reason != DropReason::kPoseTimeout || !poses_come) return lacking;
  return {DropReason::kQueueFull,
          std::to_string(queue_size_) + " newer scans wait already and " + lacking.detail};
}

void SensorInput::warn(const std::string& text) const {
  if (text.empty()) return;
  listener_->onWarning((config_.name.empty() ? "" : config_.name + ": ") + text);
}

}  // namespace fiimap
