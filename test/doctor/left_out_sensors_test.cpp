// What is wrong with one of several sensors: the line is for the others.

#include "doctor/mount.h"
#include "two_sensors.h"

namespace fiimap {
namespace {

/// No launch line makes up for it.
std::function<bool(sensor_msgs::CameraInfo*)> ofAnotherSize(const std::string& frame) {
  return [frame](sensor_msgs::CameraInfo* info) {
    info->header.frame_id = frame;
    info->width = 1280;
    return kComes;
  };
}

TEST(LeftOutSensorsTest, DoNotKeepOthersFromAMap) {
  TwoCameras cameras;
  cameras.left.info = ofAnotherSize("left_optical");
  const Diagnosis diagnosis = cameras.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"left: The camera_info", "does not fit"});
  expectFinding(diagnosis, Severity::kNote, {"launch line leaves out left until"});
  expectContains(launchLine(diagnosis), "sensors: [camera]}");
  EXPECT_EQ(launchLine(diagnosis).find("left"), std::string::npos);
  EXPECT_GT(diagnosis.trial.usable, 25u);

  cameras.vehicle.info = ofAnotherSize("camera_optical");
  EXPECT_TRUE(cameras.diagnosis().launch_words.empty());
}

TEST(LeftOutSensorsTest, LeaveNoParametersBehind) {
  TwoCameras cameras;
  cameras.vehicle.pose_delay = 0.7;
  cameras.vehicle.image_delay = 0.6;
  cameras.left.image_delay = 0.0;
  expectContains(launchLine(cameras.diagnosis()), "max_pose_wait");
  cameras.left.info = ofAnotherSize("left_optical");
  const Diagnosis diagnosis = cameras.diagnosis();
  expectContains(launchLine(diagnosis), "parameters:={sensors: [camera]}");
}

TEST(LeftOutSensorsTest, LeaveNoBodyBehind) {
  TwoCameras cameras;
  cameras.vehicle.static_transforms.back() =
      transformOf("left_link", "left_optical", opticalRotation());
  cameras.vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->child_frame_id.clear();
    return kComes;
  };
  cameras.vehicle.info = ofAnotherSize("camera_optical");
  const Diagnosis diagnosis = cameras.diagnosis();
  expectContains(launchLine(diagnosis), "body_frame:=left_link parameters:={sensors: [left]}");
  EXPECT_GT(diagnosis.trial.usable, 25u);
}

TEST(LeftOutSensorsTest, AreThoseOfWhichNoScanWouldBeUsed) {
  TwoCameras cameras;
  cameras.vehicle.static_transforms.pop_back();
  cameras.more = [](Observation* seen) {  // its place is known, but not for long
    const auto once = boost::make_shared<tf2_msgs::TFMessage>();
    once->transforms = {
        transformOf("base_link", "left_optical", opticalRotation(), {0.0, 0.3, 0.0})};
    seen->tf.push_back({once, once->transforms.front().header.stamp, 0});
  };
  const Diagnosis diagnosis = cameras.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"left: No scan would go into the map"});
  expectContains(launchLine(diagnosis), "sensors: [camera]}");
  ASSERT_EQ(diagnosis.trials.size(), 1u);
  EXPECT_GT(diagnosis.trial.usable, 25u);
}

}  // namespace
}  // namespace fiimap
