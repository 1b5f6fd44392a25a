#include "message_faults.h"

namespace fiimap {
namespace {

constexpr double kBack = -50.0;         // s
constexpr double kLittleLater = -0.08;  // s, from the moment of the next frame

void pause(FaultRig* rig) {
  rig->setNow(rig->now() + 60.0);
  rig->send(rig->next());
  rig->send(rig->next());
}

/// Scans of the new time come before its poses.
void scansBack(FaultRig* rig) {
  rig->setNow(rig->now() + kBack);
  Frame first = rig->next();
  rig->setNow(rig->now() + kLittleLater);
  Frame second = rig->next();
  std::vector<nav_msgs::Odometry> poses = first.poses;
  poses.insert(poses.end(), second.poses.begin(), second.poses.end());
  first.poses.clear();
  second.poses.clear();
  rig->send(first);
  rig->send(second);
  for (const nav_msgs::Odometry& pose : poses) rig->sendPose(pose);
}

void posesBack(FaultRig* rig) {
  rig->setNow(rig->now() + kBack);
  rig->send(rig->next());
}

void posesBackWhileAScanWaits(FaultRig* rig) {
  Frame frame = rig->next();
  frame.poses.clear();
  rig->send(frame);
  rig->waitUntilReceived();
  posesBack(rig);
}

MessageFault movedClock(double seconds) {
  return {RigInputs::kDepth, [seconds](FaultRig* rig) {
            rig->moveClock(seconds);
            rig->send(rig->next());
          }};
}

MessageFault clockAtZero() {
  MessageFault fault = movedClock(0.0);
  fault.at_start = true;
  fault.clock = 0.0;
  return fault;
}

void burst(FaultRig* rig) {
  constexpr int kScans = 100;
  rig->block();
  rig->send(rig->next());
  rig->waitUntilBlocked();
  for (int i = 0; i < kScans; ++i) rig->send(rig->next());
  rig->release();
}

}  // namespace

MessageFaults timeFaults() {
  return {
      {"time_pause", {RigInputs::kDepth, pause}},
      {"time_scans_back", {RigInputs::kDepth, scansBack}},
      {"time_poses_back", {RigInputs::kDepth, posesBack}},
      {"time_back_while_waiting", {RigInputs::kDepth, posesBackWhileAScanWaits}},
      {"time_clock_back", movedClock(-100.0)},
      {"time_clock_stops", movedClock(0.0)},
      {"time_clock_at_zero", clockAtZero()},
      {"load_burst", {RigInputs::kDepth, burst}},
  };
}

const MessageFaults& messageFaults() {
  static const MessageFaults all = [] {
    MessageFaults faults = imageFaults();
    for (MessageFaults part :
         {depthFaults(), cloudFaults(), poseFaults(), transformFaults(), timeFaults()}) {
      faults.merge(part);
    }
    return faults;
  }();
  return all;
}

}  // namespace fiimap
