#include "doctor/checks.h"
#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/pose_history.h"

namespace fiimap {

void checkPoseValues(Examination* e) {
  if (e->frames.bad() > 0) {
    e->error(
        std::to_string(e->frames.bad()) + " transforms of TF are none, the last " +
            e->frames.badExample() + ".",
        "Correct their publisher: finite numbers, quaternions of norm 1, two different frames.");
  }
  const auto found = e->seen.poses.find(e->setup.poses);
  if (found == e->seen.poses.end()) return;
  std::size_t bad = 0;
  std::string example;
  for (const auto& pose : found->second) {
    try {
      decodeTransform(pose.message->transform);
    } catch (const InputError& error) {
      ++bad;
      example = error.what();
    }
  }
  if (bad == 0) return;
  e->error(std::to_string(bad) + " of " + std::to_string(found->second.size()) + " poses of " +
               found->first + " are none, the last because " + example + ".",
           remedyFor(DropReason::kBadPose) + ".");
}

void checkMapFrame(Examination* e) {
  const auto found = e->seen.poses.find(e->setup.poses);
  if (found == e->seen.poses.end()) return;
  const std::string frame = plainFrame(found->second.back().message->header.frame_id);
  std::string& map_frame = e->setup.node.map_frame;
  if (frame.empty()) {
    e->error("The poses of " + found->first +
                 " do not say in which frame they are: "
                 "header.frame_id is empty.",
             "Let their publisher fill it in, with the frame of the map.");
    return;
  }
  if (frame == map_frame) return;
  if (e->isGiven("map_frame")) {
    e->error("The poses of " + found->first + " are in the frame '" + frame +
                 "', but map_frame is '" + map_frame + "': none of them would be used.",
             "Set map_frame:=" + frame + ".", Repair::kInLaunchLine);
  } else {
    e->note("The map is made in the frame of the poses, '" + frame + "', not in the default '" +
            map_frame + "'.");
  }
  map_frame = frame;
}

}  // namespace fiimap
