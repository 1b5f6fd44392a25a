#include "fiimap/ros/scan_synchronizer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

const std_msgs::Header& headerOf(const PoseMessage& pose) {
  return std::visit([](const auto& message) -> const std_msgs::Header& { return message.header; },
                    pose);
}

}  // namespace

ScanSynchronizer::ScanSynchronizer(const NodeConfig& config, ScanListener* listener)
    : listener_(listener), map_frame_(config.map_frame), poses_(config) {
  const std::size_t count = config.allSensors().size();
  for (std::size_t i = 0; i < count; ++i) sensors_.emplace_back(config, i, &poses_, listener);
}

void ScanSynchronizer::reconfigure(const NodeConfig& config) {
  poses_.reconfigure(config);
  for (SensorInput& sensor : sensors_) sensor.reconfigure(config);
  emitReadyScans();
}

void ScanSynchronizer::add(const PoseMessage& pose) {
  const std_msgs::Header& header = headerOf(pose);
  // Poses of another frame are refused, so they must not tell the time either.
  const bool tells_time = plainFrame(header.frame_id) == map_frame_ && !header.stamp.isZero();
  const StampVerdict verdict =
      tells_time ? pose_guard_.judge(header.stamp, newestScan()) : StampVerdict::kGood;
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
  poses_.addTf(transforms, is_static, newestScan());
  emitReadyScans();
}

void ScanSynchronizer::add(const sensor_msgs::CameraInfoConstPtr& info, std::size_t sensor) {
  sensors_.at(sensor).add(info);
  emitReadyScans();
}

void ScanSynchronizer::add(const ScanMessage& scan, const Moment& received, std::size_t sensor) {
  SensorInput& from = sensors_.at(sensor);
  if (const auto stamped = from.stamped(scan, received)) add(*stamped, &from);
}

void ScanSynchronizer::add(const SensorInput::Scan& scan, SensorInput* sensor) {
  if (!sensor->add(scan, newestScan(sensor))) {
    const std::string& name = sensor->config().name;
    restart(sensor->newestGood(), scan.stamp, name.empty() ? "scans" : "the scans of " + name);
    sensor->add(scan, newestScan(sensor));
  }
  emitReadyScans();
  while (sensor->dropExcess()) emitReadyScans();
}

void ScanSynchronizer::restart(const ros::Time& newest, const ros::Time& stamp,
                               const std::string& what) {
  restart("the stamps of " + what + " went back by " +
          std::to_string(secondsBetween(stamp, newest)) + " s");
}

void ScanSynchronizer::restart(const std::string& why) {
  // What is doubtful and older than the others belongs to the new time.
  std::vector<std::optional<SensorInput::Scan>> scans;
  for (SensorInput& sensor : sensors_) scans.push_back(sensor.restart(why));
  if (doubtful_pose_ && headerOf(*doubtful_pose_).stamp > pose_guard_.newest()) {
    refuseDoubtfulPose();
  }
  const auto pose = std::exchange(doubtful_pose_, std::nullopt);
  poses_.clear();
  pose_guard_.clear();
  listener_->onTimeJump(why);
  if (pose) add(*pose);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i]) add(*scans[i], &sensors_[i]);
  }
}

void ScanSynchronizer::emitReadyScans() {
  while (true) {
    SensorInput* oldest = nullptr;
    SensorInput::Match match;
    for (SensorInput& sensor : sensors_) {
      const std::optional<SensorInput::Match> found = sensor.matchFront();
      if (!found || (oldest != nullptr && oldest->front() <= sensor.front())) continue;
      oldest = &sensor;
      match = *found;
    }
    if (oldest == nullptr) return;
    listener_->onScan(oldest->takeFront(match));
  }
}

void ScanSynchronizer::expire(const Moment& now) {
  for (SensorInput& sensor : sensors_) {
    while (sensor.expireFront(now)) emitReadyScans();
  }
}

void ScanSynchronizer::finish() {
  for (SensorInput& sensor : sensors_) sensor.finish();
}

/// Of all sensors but one; a clock that is far ahead tells the others nothing.
ros::Time ScanSynchronizer::newestScan(const SensorInput* without) const {
  ros::Time newest;
  for (const SensorInput& sensor : sensors_) {
    if (&sensor == without || isFarAhead(sensor)) continue;
    newest = std::max(newest, sensor.newest());
  }
  return newest;
}

/// Of all the other sensors that sent something.
bool ScanSynchronizer::isFarAhead(const SensorInput& sensor) const {
  ros::Time others;
  for (const SensorInput& other : sensors_) {
    if (&other != &sensor) others = std::max(others, other.newest());
  }
  return !others.isZero() && secondsBetween(others, sensor.newest()) > StampGuard::kJump;
}

}  // namespace fiimap
