#include "fiimap/ros/drop_reason.h"

#include <set>

#include <gtest/gtest.h>

#include "fiimap/ros/scan_counters.h"

namespace fiimap {
namespace {

TEST(DropReasonTest, EveryReasonHasItsOwnNameAndARemedy) {
  std::set<std::string> names;
  for (int i = 0; i < kDropReasonCount; ++i) {
    const auto reason = static_cast<DropReason>(i);
    EXPECT_TRUE(names.insert(nameOf(reason)).second) << nameOf(reason);
    EXPECT_FALSE(std::string(remedyFor(reason)).empty());
  }
}

TEST(DropReasonTest, TheTableIsInTheOrderOfTheReasons) {
  EXPECT_STREQ(nameOf(DropReason::kZeroStamp), "zero_stamp");
  EXPECT_STREQ(nameOf(DropReason::kPoseTimeout), "pose_timeout");
  EXPECT_STREQ(nameOf(DropReason::kFrameMismatch), "frame_mismatch");
  EXPECT_STREQ(nameOf(DropReason::kBadCameraInfo), "bad_camera_info");
  EXPECT_STREQ(nameOf(DropReason::kOverload), "overload");
}

TEST(DropReasonTest, RemediesNameWhatIsTheSensorsOwn) {
  const auto ends = [](const Drop& drop, const std::string& end) {
    const std::string text = drop.text();
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
  };
  EXPECT_TRUE(ends({DropReason::kNoCameraInfo, "none", "front"}, "remap front/depth/camera_info"));
  EXPECT_TRUE(ends({DropReason::kNoCameraInfo, "none"}, "remap depth/camera_info"));
  EXPECT_TRUE(ends({DropReason::kNoExtrinsics, "none", "front"},
                   "correct body_frame, or set front/extrinsics to parameter with "
                   "front/extrinsic_translation and front/extrinsic_rotation"));
  EXPECT_TRUE(ends({DropReason::kPoseTooOld, "old", "front"},
                   "set front/time_offset; a few at the start are harmless"));
}

TEST(ScanCountersTest, AddsUp) {
  ScanCounters counters;
  counters.received = 5;
  counters.integrated = 1;
  counters.countDrop({DropReason::kPoseGap, "a"});
  counters.countDrop({DropReason::kPoseGap, "b"});
  counters.countDrop({DropReason::kOverload, "c"});
  EXPECT_EQ(counters.dropped(DropReason::kPoseGap), 2u);
  EXPECT_EQ(counters.dropped(), 3u);
  EXPECT_EQ(counters.last_drop.find("overload: c"), 0u);
}

}  // namespace
}  // namespace fiimap
