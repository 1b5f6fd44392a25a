#pragma once

#include <stdexcept>
#include <string>

namespace fiimap {

/// Why a scan did not become part of the map.
enum class DropReason {
  kZeroStamp,      ///< the message has no stamp, or one that is no time
  kStaleStamp,     ///< not newer than the scan before, or alone far from all others
  kTimeJump,       ///< waited while the stamps jumped back
  kQueueFull,      ///< displaced by newer scans while it waited for its pose
  kPoseTimeout,    ///< no pose at or after its stamp came in time
  kPoseTooOld,     ///< older than every pose that is kept
  kPoseGap,        ///< the poses around it are too far apart in time
  kBadPose,        ///< poses are not finite, not rotations, or out of the map's range
  kFrameMismatch,  ///< poses are in another frame than map_frame
  kNoExtrinsics,   ///< sensor frame and body frame are not connected
  kNoCameraInfo,   ///< no camera_info for the depth image
  kBadCameraInfo,  ///< intrinsics are zero or of another image size
  kBadImage,       ///< sizes in the message contradict each other
  kBadEncoding,    ///< not a depth image's encoding
  kBadCloud,       ///< not one each of x y z of type float32, or sizes contradict each other
  kOverload,       ///< newer scans came before the map had time for it
};
/// Number of reasons.
constexpr int kDropReasonCount = static_cast<int>(DropReason::kOverload) + 1;

/// Name for messages, JSON and diagnostics, for instance "pose_timeout".
const char* nameOf(DropReason reason);
/// What a user can do about it: one sentence without full stop.
/// \param sensor name of the one that it is said of; what is its own is named with it.
std::string remedyFor(DropReason reason, const std::string& sensor = "");

/// One dropped scan.
struct Drop {
  DropReason reason = DropReason::kZeroStamp;  ///< why
  std::string detail;                          ///< what was found, with the values
  std::string sensor{};  ///< name of the scan's; empty where there is one only

  /// "name: detail; remedy", with the sensor before the detail where it has a name.
  std::string text() const;
};

/// Data that cannot be used; the scan or pose that holds it is dropped.
class InputError : public std::runtime_error {
 public:
  /// \param detail what was found, with the values.
  InputError(DropReason reason, const std::string& detail)
      : std::runtime_error(detail), reason_(reason) {}

  /// What is wrong with the data.
  DropReason reason() const { return reason_; }
  /// The drop of what holds the data.
  Drop drop() const { return {reason_, what(), ""}; }

 private:
  DropReason reason_;
};

}  // namespace fiimap
