#include "fiimap/ros/stamp_guard.h"

#include <algorithm>
#include <utility>

#include "fiimap/ros/stamps.h"

namespace fiimap {

StampVerdict StampGuard::judge(const ros::Time& stamp, const ros::Time& other) {
  const ros::Time doubtful = std::exchange(doubtful_, ros::Time());
  // What the very first stamp is ahead of, nobody knows.
  const bool first = newest_.isZero() && other.isZero();
  const bool back = secondsBetween(stamp, newest_) > kJump;
  const bool ahead = !first && secondsBetween(std::max(newest_, other), stamp) > kJump;
  if (!back && !ahead) {
    const bool was_right = doubtful > newest_ && doubtful <= stamp;
    newest_ = std::max(newest_, stamp);
    return was_right ? StampVerdict::kLeap : StampVerdict::kGood;
  }
  const bool again =
      back ? !doubtful.isZero() && doubtful < newest_ : doubtful > newest_ && stamp >= doubtful;
  if (!again) {
    doubtful_ = stamp;
    return StampVerdict::kDoubtful;
  }
  if (back) return StampVerdict::kJumpBack;
  newest_ = stamp;
  return StampVerdict::kLeap;
}

void StampGuard::clear() { *this = StampGuard(); }

Drop strayStamp(const std::string& what, const ros::Time& newest, const ros::Time& stamp) {
  return {DropReason::kStaleStamp, what + " alone is stamped " +
                                       std::to_string(secondsBetween(newest, stamp)) +
                                       " s after the one before"};
}

}  // namespace fiimap
