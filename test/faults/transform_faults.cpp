#include <limits>

#include "message_faults.h"

namespace fiimap {
namespace {

using geometry_msgs::TransformStamped;

/// Spoils every transform of a frame.
MessageFault transforms(const std::function<void(TransformStamped*)>& spoil) {
  return {RigInputs::kTf, [spoil](FaultRig* rig) {
            Frame frame = rig->next();
            for (TransformStamped& transform : frame.transforms) spoil(&transform);
            rig->send(frame);
          }};
}

/// A good frame with one more transform in front of it.
MessageFault stray(double seconds_later, bool at_start = false) {
  return {RigInputs::kTf,
          [seconds_later](FaultRig* rig) {
            rig->sendTransform(rig->transformAt(rig->now() + seconds_later));
            rig->send(rig->next());
          },
          at_start};
}

/// A frame with these transforms only; times in seconds from that of the good frame.
MessageFault transformsAt(const std::vector<double>& times, bool at_start = false) {
  return {RigInputs::kTf,
          [times](FaultRig* rig) {
            Frame frame = rig->next();
            frame.transforms.clear();
            for (const double seconds : times) {
              frame.transforms.push_back(rig->transformAt(rig->now() + seconds));
            }
            rig->send(frame);
          },
          at_start};
}

/// A link that moves, for one that does not may be told seldom.
void sendAfterGap(FaultRig* rig) {
  Frame frame = rig->next();
  frame.transforms = {rig->transformAt(rig->now() + FaultRig::kPeriod)};
  frame.transforms[0].transform.translation.x = 0.01;
  rig->send(frame);
}

void sendNameless(FaultRig* rig) {
  for (const char* child : {"world", ""}) {
    TransformStamped transform = rig->transformAt(rig->now());
    transform.child_frame_id = child;
    rig->sendTransform(transform);
  }
  rig->send(rig->next());
}

}  // namespace

MessageFaults transformFaults() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"tf_never", transformsAt({}, true)},
      {"tf_stops", transformsAt({})},
      {"tf_cycle", transforms([](TransformStamped* t) { t->header.frame_id = "camera"; })},
      {"tf_self", {RigInputs::kTf, sendNameless}},
      {"tf_nan", transforms([=](TransformStamped* t) { t->transform.translation.z = nan; })},
      {"tf_quaternion_zero",
       transforms([](TransformStamped* t) { t->transform.rotation.w = 0.0; })},
      {"tf_too_old", transformsAt({0.01, 0.02}, true)},
      {"tf_gap", {RigInputs::kTf, sendAfterGap}},
      {"tf_future", stray(100.0)},
      {"tf_past", stray(-100.0)},
      {"tf_first_in_future", stray(100.0, true)},
  };
}

}  // namespace fiimap
