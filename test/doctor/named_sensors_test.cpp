// Several sensors whose topics the user named.

#include <stdexcept>

#include "two_sensors.h"

namespace fiimap {
namespace {

const std::string kAhead = "/camera/depth/image_rect_raw", kAheadInfo = "/camera/depth/camera_info";
const std::string kLeft = "/left/depth/image_rect_raw", kLeftInfo = "/left/depth/camera_info";

/// What is said of wishes that are refused.
std::string refusalOf(const DoctorWishes& wishes, TwoCameras cameras = {}) {
  try {
    cameras.diagnosis(wishes);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return "";
}

DoctorWishes bothImages() {
  DoctorWishes wishes;
  wishes.depth_images = {kAhead, kLeft};
  return wishes;
}

TEST(NamedSensorsTest, TellColourFromDepth) {
  TwoCameras cameras;
  cameras.left.image = [](sensor_msgs::Image* image) {
    image->header.frame_id = "left_optical";
    image->encoding = "rgb8";
    return kComes;
  };
  DoctorWishes with_infos = bothImages();
  with_infos.camera_infos = {kAheadInfo, kLeftInfo};
  DoctorWishes with_names = bothImages();
  with_names.parameters = {{"sensors", "camera left"}};
  for (const DoctorWishes& wishes : {bothImages(), with_infos, with_names}) {
    const Diagnosis diagnosis = cameras.diagnosis(wishes);
    expectFinding(diagnosis, Severity::kError,
                  {"left: The image " + kLeft + " has the encoding 'rgb8'", "32FC1: " + kAhead});
    EXPECT_EQ(diagnosis.count(Severity::kError), 1u);
    expectContains(launchLine(diagnosis), "sensors: [camera]}");
  }
}

TEST(NamedSensorsTest, SayThatAnImageIsSilent) {
  TwoCameras cameras;
  cameras.left.image = [](auto*) { return !kComes; };
  cameras.more = [](Observation* seen) { seen->types[kLeft] = "sensor_msgs/Image"; };
  DoctorWishes with_names = bothImages();
  with_names.parameters = {{"sensors", "front side"}};
  for (const DoctorWishes& wishes : {bothImages(), with_names}) {
    const Diagnosis diagnosis = cameras.diagnosis(wishes);
    expectFinding(diagnosis, Severity::kError, {"No message came on " + kLeft});
    EXPECT_EQ(diagnosis.setup.sensors.size(), 1u);
  }
}

TEST(NamedSensorsTest, TakeTheCameraInfoInThePlaceOfTheImage) {
  TwoCameras cameras;
  cameras.left.info_topic = "/driver/info";
  cameras.left.info = TwoCameras::setFrame<sensor_msgs::CameraInfo>("driver");
  DoctorWishes wishes = bothImages();
  wishes.camera_infos = {kAheadInfo, "/driver/info"};
  expectContains(launchLine(cameras.diagnosis(wishes)), "left/depth/camera_info=/driver/info");
  wishes.parameters = {{"sensors", "left right"}};
  expectContains(launchLine(cameras.diagnosis(wishes)), "left/depth/camera_info=/driver/info");
}

TEST(NamedSensorsTest, SayThatACameraInfoIsSilent) {
  TwoCameras cameras;
  cameras.more = [](Observation* seen) { seen->types["/info"] = "sensor_msgs/CameraInfo"; };
  DoctorWishes wishes = bothImages();
  wishes.camera_infos = {kAheadInfo, "/info"};
  const Diagnosis diagnosis = cameras.diagnosis(wishes);
  expectFinding(diagnosis, Severity::kWarning,
                {"No message came on /info, the camera_info that is named for " + kLeft +
                 "; that of " + kLeftInfo + " is taken"});
  expectContains(launchLine(diagnosis), "left/depth/camera_info=" + kLeftInfo);

  cameras.left.info = [](auto*) { return !kComes; };
  const Diagnosis without = cameras.diagnosis(wishes);
  expectFinding(without, Severity::kError,
                {"left: The depth image " + kLeft + " has no camera_info", "/info (silent)"});
  expectContains(launchLine(without), "sensors: [camera]}");

  wishes.depth_images = {kAhead};
  wishes.camera_infos = {"/info"};
  expectFinding(cameras.diagnosis(wishes), Severity::kWarning, {"No message came on /info"});
}

TEST(NamedSensorsTest, AskOfWhichImageACameraInfoIs) {
  DoctorWishes wishes;
  wishes.camera_infos = {kLeftInfo};
  expectContains(refusalOf(wishes), "--camera-info " + kLeftInfo + ": of which depth image? " +
                                        "There are " + kAhead + ", " + kLeft);
  wishes.parameters = {{"sensors", "left right"}};
  expectContains(refusalOf(wishes), "of which depth image?");

  SeenVehicle vehicle = withCameraAndLidar();
  vehicle.info_topic = "/driver/info";
  wishes = {};
  wishes.camera_infos = {"/driver/info"};
  const Diagnosis one_camera = vehicle.diagnosis(wishes);
  expectNothingWrong(one_camera);
  expectContains(launchLine(one_camera), "camera/depth/camera_info=/driver/info");
  wishes.points = {"/velodyne_points"};
  expectFinding(vehicle.diagnosis(wishes), Severity::kWarning,
                {"--camera-info /driver/info is of no use"});
}

TEST(NamedSensorsTest, RefuseTopicsThatAreOfNoUse) {
  DoctorWishes wishes = bothImages();
  wishes.depth_images.push_back(kAhead);
  EXPECT_EQ(refusalOf(wishes), "--depth-image " + kAhead + " is named twice");
  wishes.depth_images.back() = "/odom";
  expectContains(refusalOf(wishes), "--depth-image /odom: its type is nav_msgs/Odometry");
  wishes.parameters = {{"sensors", "one other third"}};
  expectContains(refusalOf(wishes), "--depth-image /odom: its type is nav_msgs/Odometry");
  wishes = bothImages();
  wishes.parameters = {{"sensors", "left"}};
  expectContains(refusalOf(wishes), "more than the sensors that take it: left");
  wishes.camera_infos = {"/odom"};
  wishes.parameters.clear();
  expectContains(refusalOf(wishes), "--camera-info /odom: its type is nav_msgs/Odometry");
}

TEST(NamedSensorsTest, AreNoMoreThanAMapCanHave) {
  TwoCameras cameras;
  DoctorWishes wishes;
  for (std::size_t i = 0; i <= NodeConfig::kMaxSensors; ++i) {
    wishes.points.push_back("/points" + std::to_string(i));
  }
  cameras.more = [&wishes](Observation* seen) {
    for (const std::string& topic : wishes.points) seen->types[topic] = "sensor_msgs/PointCloud2";
  };
  expectContains(refusalOf(wishes, cameras), "name 33 sensors; a map has at most 32");
}

}  // namespace
}  // namespace fiimap
