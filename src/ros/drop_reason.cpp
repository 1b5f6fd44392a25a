#include "fiimap/ros/drop_reason.h"

#include <array>

namespace fiimap {
namespace {

struct Entry {
  const char* name;
  const char* remedy;
};

// In remedies: before the name of what each of several sensors has of its own.
constexpr char kOwn = '@';

// In the order of DropReason.
constexpr std::array<Entry, kDropReasonCount> kEntries = {{
    {"zero_stamp", "the driver must fill header.stamp"},
    {"stale_stamp", "make sure that one publisher only writes this topic, with increasing stamps"},
    {"time_jump", "nothing to do when a bag was started again; otherwise check the clocks"},
    {"queue_full", "raise scan_queue_size, or find out why poses come late"},
    {"pose_timeout",
     "check that poses are published and remapped to the topic that pose_source names, that their "
     "stamps are from the sensor's clock (else set @time_offset), or raise max_pose_wait"},
    {"pose_too_old", "raise pose_history, or set @time_offset; a few at the start are harmless"},
    {"pose_gap", "publish poses more often, or raise max_pose_gap"},
    {"bad_pose", "check the source of the poses: it must be finite with unit quaternions"},
    {"frame_mismatch", "set map_frame to the header.frame_id of the poses"},
    {"no_extrinsics",
     "publish a static transform between body and sensor frame, correct body_frame, or set "
     "@extrinsics to parameter with @extrinsic_translation and @extrinsic_rotation"},
    {"no_camera_info", "publish camera_info beside the image, or remap @depth/camera_info"},
    {"bad_camera_info", "use the camera_info that belongs to this image; calibrate the camera"},
    {"bad_image", "check the driver: width, height, step and data must agree"},
    {"bad_encoding", "use a depth image of encoding 16UC1, mono16 or 32FC1"},
    {"bad_cloud",
     "use a cloud with one field each of x, y and z, of type float32 in the machine's byte order, "
     "whose width, height, point_step, row_step and data agree"},
    {"overload",
     "raise resolution or @pixel_step, lower @max_depth or the sensor's rate, or build in release "
     "mode"},
}};

}  // namespace

const char* nameOf(DropReason reason) { return kEntries[static_cast<std::size_t>(reason)].name; }

std::string remedyFor(DropReason reason, const std::string& sensor) {
  std::string text = kEntries[static_cast<std::size_t>(reason)].remedy;
  const std::string prefix = sensor.empty() ? "" : sensor + '/';
  for (std::size_t at = text.find(kOwn); at != std::string::npos; at = text.find(kOwn, at)) {
    text.replace(at, 1, prefix);
  }
  return text;
}

std::string Drop::text() const {
  const std::string who = sensor.empty() ? "" : sensor + ": ";
  return std::string(nameOf(reason)) + ": " + who + detail + "; " + remedyFor(reason, sensor);
}

}  // namespace fiimap
