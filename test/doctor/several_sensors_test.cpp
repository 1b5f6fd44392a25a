// Several sensors: which there are, and the line for one map of them all.

#include "doctor/mount.h"
#include "two_sensors.h"

namespace fiimap {
namespace {

TEST(SeveralSensorsTest, MakeOneMapOfACameraAndALidar) {
  const Diagnosis diagnosis = withCameraAndLidar().diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote,
                {"One map is made of 2 sensors: 'camera' (depth images on "
                 "/camera/depth/image_rect_raw), 'velodyne' (clouds on /velodyne_points)"});
  expectFinding(diagnosis, Severity::kNote, {"'velodyne' reach far", "20 m long", "40 m wide"});
  EXPECT_EQ(launchLine(diagnosis),
            "roslaunch fiimap mapping.launch sensor:=depth "
            "topics:=camera/depth/image=/camera/depth/image_rect_raw "
            "camera/depth/camera_info=/camera/depth/camera_info velodyne/points=/velodyne_points "
            "pose_source:=odometry odom:=/odom map_frame:=world "
            "parameters:={local_update_range_x: 40, local_update_range_y: 40, "
            "sensors: [camera, velodyne], "
            "velodyne: {max_ray_length: 20, min_ray_length: 0.5, sensor: points}}");
  ASSERT_EQ(diagnosis.trials.size(), 2u);
  EXPECT_GT(diagnosis.trials[0].usable, 25u);
  EXPECT_GT(diagnosis.trials[1].usable, 25u);
}

TEST(SeveralSensorsTest, MakeOneMapOfTwoCameras) {
  const Diagnosis diagnosis = TwoCameras().diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote, {"left: The camera", "looks to the left"});
  expectContains(launchLine(diagnosis), "left/depth/image=/left/depth/image_rect_raw");
  expectContains(launchLine(diagnosis), "parameters:={sensors: [camera, left]}");
  ASSERT_EQ(diagnosis.trials.size(), 2u);
  EXPECT_GT(diagnosis.trials[1].usable, 25u);
  EXPECT_EQ(diagnosis.topics.size(), 5u);
}

TEST(SeveralSensorsTest, GiveALidarOnlyTheRangesThatAreOpen) {
  DoctorWishes wishes;
  wishes.parameters = {{"min_ray_length", "1"}};
  expectContains(launchLine(withCameraAndLidar().diagnosis(wishes)),
                 "velodyne: {max_ray_length: 20, sensor: points}");
  wishes.parameters = {{"sensors", "camera velodyne"},
                       {"velodyne/sensor", "points"},
                       {"velodyne/min_ray_length", "1"}};
  expectContains(launchLine(withCameraAndLidar().diagnosis(wishes)),
                 "velodyne: {max_ray_length: 20, min_ray_length: 1, sensor: points}");
}

TEST(SeveralSensorsTest, TellHowManyScansOfEach) {
  const Observation seen = withCameraAndLidar().observation();
  const Diagnosis diagnosis = diagnose(seen, {});
  const std::string text = toText(diagnosis, seen);
  expectContains(text, "scans that came would have gone into the map: camera ");
  expectContains(text, ", velodyne " + std::to_string(diagnosis.trials[1].usable) + " of 30");
}

TEST(SeveralSensorsTest, TakeTwoImagesOfOneHousingForOneSensor) {
  TwoCameras cameras;  // as a RealSense has them, 15 mm apart
  cameras.left.image_topic = "/camera/aligned_depth_to_color/image_raw";
  cameras.left.info_topic = "/camera/aligned_depth_to_color/camera_info";
  cameras.vehicle.static_transforms.back() =
      transformOf("base_link", "left_optical", opticalRotation(), {0.1, 0.015, 0.0});
  const Diagnosis diagnosis = cameras.diagnosis();
  EXPECT_TRUE(diagnosis.setup.sensors.empty());
  expectFinding(diagnosis, Severity::kNote, {"Of several depth images", "aligned_depth_to_color"});
  // Without TF, by the name.
  cameras.vehicle.static_transforms.pop_back();
  EXPECT_TRUE(cameras.diagnosis().setup.sensors.empty());
}

TEST(SeveralSensorsTest, TakeNoMovedCloudForASensor) {
  for (const char* frame : {"world", "base_link", "camera_optical"}) {
    SeenVehicle vehicle = withCameraAndLidar();
    vehicle.cloud = TwoCameras::setFrame<sensor_msgs::PointCloud2>(frame);
    EXPECT_TRUE(vehicle.diagnosis().setup.sensors.empty()) << frame;
  }
}

TEST(SeveralSensorsTest, SayWhatIsNoSensorOfItsOwn) {
  TwoCameras cameras;
  const Observation lidar = withCameraAndLidar().observation();
  const Observation left = cameras.left.observation();
  cameras.vehicle.more = [&](Observation* seen) {
    addScans(left, seen);
    seen->images["/thermal/image"] = left.images.at("/left/depth/image_rect_raw");
    seen->depth["/thermal/image"] = left.depth.at("/left/depth/image_rect_raw");
    seen->clouds["/registered"] = lidar.clouds.at("/velodyne_points");
    seen->points["/registered"] = lidar.points.at("/velodyne_points");
    for (auto& received : seen->clouds["/registered"]) {
      auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*received.message);
      cloud->header.frame_id = "world";
      received.message = cloud;
    }
  };
  const Diagnosis diagnosis = cameras.vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.sensors.size(), 2u);
  expectFinding(diagnosis, Severity::kNote,
                {"Not taken for sensors",
                 "/thermal/image (seems to be of the same device as /left/depth/image_rect_raw)",
                 "/registered (is in the frame of the poses, 'world')"});
}

TEST(SeveralSensorsTest, GiveEachItsOwnPlace) {
  TwoCameras cameras;
  cameras.vehicle.static_transforms.pop_back();
  const Diagnosis diagnosis = cameras.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"left: TF does not say where", "'left_optical'"});
  expectContains(launchLine(diagnosis),
                 "{sensors: [camera, left], left: {extrinsic_rotation: [-0.5, 0.5, -0.5, 0.5], "
                 "extrinsic_translation: [0, 0, 0], "
                 "extrinsics: parameter}}");
  EXPECT_GT(diagnosis.trials[1].usable, 25u);  // the line does what it says
}

TEST(SeveralSensorsTest, TakeNoBodyThatDoesNotCarryAll) {
  TwoCameras cameras;
  cameras.vehicle.static_transforms.back() =
      transformOf("left_link", "left_optical", opticalRotation());
  const Diagnosis diagnosis = cameras.diagnosis();
  EXPECT_EQ(launchLine(diagnosis).find("body_frame:="), std::string::npos);
  expectContains(launchLine(diagnosis), "left: {");
  EXPECT_GT(diagnosis.trials[0].usable, 25u);
  EXPECT_GT(diagnosis.trials[1].usable, 25u);
}

TEST(SeveralSensorsTest, TakePosesOfAllFromTf) {
  TwoCameras cameras;
  cameras.vehicle.pose = [](auto*) { return !kComes; };
  cameras.left.pose = cameras.vehicle.pose;
  cameras.vehicle.pose_on_tf = cameras.left.pose_on_tf = true;  // the same order of arrival
  const Diagnosis diagnosis = cameras.diagnosis();
  expectNothingWrong(diagnosis);
  expectContains(launchLine(diagnosis), "pose_source:=tf map_frame:=world body_frame:=base_link");
  EXPECT_GT(diagnosis.trials[1].usable, 25u);
}

TEST(SeveralSensorsTest, SayOnceWhatIsTheSameOfAll) {
  TwoCameras cameras;
  cameras.vehicle.image_rate = cameras.left.image_rate = 1.0;
  const Diagnosis diagnosis = cameras.diagnosis();
  EXPECT_EQ(diagnosis.count(Severity::kWarning), 1u);
  const Finding finding =
      expectFinding(diagnosis, Severity::kWarning, {"Scans come at 1.0 Hz only"});
  EXPECT_EQ(finding.what.find("left"), std::string::npos);
}

TEST(SeveralSensorsTest, FollowTheUser) {
  TwoCameras cameras;
  DoctorWishes wishes;
  wishes.depth_images = {"/camera/depth/image_rect_raw"};
  EXPECT_TRUE(cameras.diagnosis(wishes).setup.sensors.empty());
  wishes.depth_images = {"/left/depth/image_rect_raw", "/camera/depth/image_rect_raw"};
  expectContains(launchLine(cameras.diagnosis(wishes)), "sensors: [left, camera]}");
  wishes = {};
  wishes.parameters = {{"sensors", "side front"}, {"side/max_depth", "3"}};
  const Diagnosis named = cameras.diagnosis(wishes);
  expectContains(launchLine(named), "sensors: [side, front], side: {max_depth: 3}}");
  EXPECT_EQ(named.setup.sensors.size(), 2u);
  wishes = {};
  wishes.parameters = {{"sensors", "left right rear"}};
  const Diagnosis too_many = cameras.diagnosis(wishes);
  EXPECT_EQ(too_many.setup.sensors.front().depth_image, "/left/depth/image_rect_raw");
  expectFinding(too_many, Severity::kError, {"There are no depth images for the sensor 'rear'"});
}

TEST(SeveralSensorsTest, UseTheFileOfLidarsForLidars) {
  SeenVehicle vehicle = withCameraAndLidar();
  vehicle.image = [](auto*) { return !kComes; };
  SeenVehicle other = vehicle;
  other.cloud_topic = "/rear/points";
  other.cloud = TwoCameras::setFrame<sensor_msgs::PointCloud2>("rear");
  vehicle.static_transforms.push_back(
      transformOf("base_link", "rear", Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0}));
  const Observation of_other = other.observation();
  vehicle.more = [&of_other](Observation* seen) { addScans(of_other, seen); };
  const std::string line = launchLine(vehicle.diagnosis());
  expectContains(line,
                 "lidar.launch topics:=rear/points=/rear/points velodyne/points=/velodyne_points");
  expectContains(line, "parameters:={sensors: [rear, velodyne]}");
}

}  // namespace
}  // namespace fiimap
