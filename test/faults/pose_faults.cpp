#include <algorithm>
#include <limits>

#include "message_faults.h"

namespace fiimap {
namespace {

using nav_msgs::Odometry;

/// Spoils every pose of a frame.
MessageFault poses(const std::function<void(Odometry*)>& spoil) {
  return {RigInputs::kDepth, [spoil](FaultRig* rig) {
            Frame frame = rig->next();
            for (Odometry& pose : frame.poses) spoil(&pose);
            rig->send(frame);
          }};
}

/// A good frame with one more pose in front of it.
MessageFault strayPose(double seconds_later) {
  return {RigInputs::kDepth, [seconds_later](FaultRig* rig) {
            rig->sendPose(rig->poseAt(rig->now() + seconds_later));
            rig->send(rig->next());
          }};
}

/// A frame with these poses only; times in seconds from that of the good frame.
MessageFault posesAt(const std::vector<double>& times, bool at_start = false) {
  return {RigInputs::kDepth,
          [times](FaultRig* rig) {
            Frame frame = rig->next();
            frame.poses.clear();
            for (const double seconds : times) {
              frame.poses.push_back(rig->poseAt(rig->now() + seconds));
            }
            rig->send(frame);
          },
          at_start};
}

void jump(FaultRig* rig) {
  Frame frame = rig->next();
  for (Odometry& pose : frame.poses) pose.pose.pose.position.x += 200.0;
  rig->send(frame);
}

void fastPoses(FaultRig* rig) {
  constexpr double kFrequency = 10000.0;  // Hz
  constexpr int kCount = 5000;
  const double start = rig->now();
  for (int i = 1; i <= kCount; ++i) rig->sendPose(rig->poseAt(start + i / kFrequency));
  rig->setNow(start + kCount / kFrequency - FaultRig::kPeriod);
  Frame frame = rig->next();
  frame.poses.clear();
  rig->send(frame);
}

/// More scans than may wait, then the poses of all.
void lagBehind(FaultRig* rig) {
  constexpr int kScans = 12;
  constexpr double kStep = 0.002;  // s; the wait is not over when the last one comes
  for (int i = 0; i < kScans; ++i) {
    rig->setNow(rig->now() + kStep - FaultRig::kPeriod);
    Frame frame = rig->next();
    frame.poses.clear();
    frame.image->header.stamp = rig->stampAt(rig->now());
    rig->send(frame);
    rig->waitUntilReceived();
  }
  rig->sendPose(rig->poseAt(rig->now() + kStep));
}

}  // namespace

MessageFaults poseFaults() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  return {
      {"pose_never", posesAt({}, true)},
      {"pose_stops", posesAt({})},
      {"pose_nan", poses([=](Odometry* p) { p->pose.pose.position.x = nan; })},
      {"pose_infinite", poses([=](Odometry* p) { p->pose.pose.orientation.z = infinity; })},
      {"pose_quaternion_zero", poses([](Odometry* p) { p->pose.pose.orientation.w = 0.0; })},
      {"pose_quaternion_long", poses([](Odometry* p) { p->pose.pose.orientation.w = 2.0; })},
      {"pose_quaternion_rounded", poses([](Odometry* p) { p->pose.pose.orientation.w = 1.01; })},
      {"pose_out_of_range", poses([](Odometry* p) { p->pose.pose.position.y = 1e15; })},
      {"pose_other_frame", poses([](Odometry* p) { p->header.frame_id = "map"; })},
      {"pose_zero_stamp", poses([](Odometry* p) { p->header.stamp = ros::Time(); })},
      {"pose_future", strayPose(100.0)},
      {"pose_past", strayPose(-100.0)},
      {"pose_late", strayPose(-0.05)},
      {"pose_twice", posesAt({-0.02, -0.02, 0.0, 0.0})},
      {"pose_jump", {RigInputs::kDepth, jump}},
      {"pose_gap", posesAt({0.1})},
      {"pose_1_hz",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          rig->setNow(rig->now() + 0.5);
          Frame frame = rig->next();
          frame.poses = {rig->poseAt(rig->now() + 0.399)};
          rig->send(frame);
        }}},
      {"pose_10_khz", {RigInputs::kDepth, fastPoses}},
      {"pose_too_old", posesAt({0.01, 0.02}, true)},
      {"pose_behind", {RigInputs::kDepth, lagBehind}},
  };
}

}  // namespace fiimap
