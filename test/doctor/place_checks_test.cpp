// Where the sensor is on the body: body_frame, extrinsics, the mount of the camera.

#include "doctor/mount.h"
#include "seen_vehicle.h"

namespace fiimap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turned(double degrees, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(degrees * M_PI / 180.0, axis));
}

/// With the camera turned on the body, from looking ahead.
Diagnosis withCameraTurned(double degrees, const Vector3d& axis_B) {
  SeenVehicle vehicle;
  vehicle.static_transforms = {
      transformOf("base_link", "camera_optical", turned(degrees, axis_B) * opticalRotation())};
  return vehicle.diagnosis();
}

TEST(MountTest, TellsDirections) {
  const auto direction = [](const Quaterniond& q) {
    return Mount(Eigen::Isometry3d(q)).direction();
  };
  EXPECT_EQ(direction(opticalRotation()), "ahead");
  EXPECT_EQ(direction(turned(180, Vector3d::UnitZ()) * opticalRotation()), "backwards");
  EXPECT_EQ(direction(turned(90, Vector3d::UnitZ()) * opticalRotation()), "to the left");
  EXPECT_EQ(direction(turned(-90, Vector3d::UnitZ()) * opticalRotation()), "to the right");
  EXPECT_EQ(direction(turned(90, Vector3d::UnitY()) * opticalRotation()), "down");
  EXPECT_EQ(direction(turned(-90, Vector3d::UnitY()) * opticalRotation()), "up");
}

TEST(MountTest, TellsRoll) {
  const auto roll = [](double degrees) {
    const Quaterniond q = turned(degrees, Vector3d::UnitX()) * opticalRotation();
    return Mount(Eigen::Isometry3d(q)).rollDegrees();
  };
  EXPECT_NEAR(roll(0.0), 0.0, 1e-6);
  EXPECT_NEAR(roll(90.0), 90.0, 1e-6);
  EXPECT_NEAR(roll(180.0), 180.0, 1e-6);
}

TEST(PlaceChecksTest, OnlyWonderAtCamerasThatLookElsewhere) {
  const Diagnosis backwards = withCameraTurned(180.0, Vector3d::UnitZ());
  expectFinding(backwards, Severity::kWarning, {"looks backwards", "-1 0 0 in the body"});
  EXPECT_EQ(backwards.count(Severity::kError), 0u);
  EXPECT_FALSE(backwards.launch_words.empty());
  expectFinding(withCameraTurned(90.0, Vector3d::UnitZ()), Severity::kWarning,
                {"looks to the left"});
  expectFinding(withCameraTurned(-90.0, Vector3d::UnitY()), Severity::kWarning, {"looks up"});
  expectFinding(withCameraTurned(90.0, Vector3d::UnitX()), Severity::kWarning,
                {"rolled by 90 degrees"});
}

TEST(PlaceChecksTest, AcceptCamerasThatLookAheadOrDown) {
  expectNothingWrong(withCameraTurned(20.0, Vector3d::UnitY()));
  expectNothingWrong(withCameraTurned(90.0, Vector3d::UnitY()));
}

SeenVehicle withFrame(const std::string& frame) {
  SeenVehicle vehicle;
  vehicle.image = [frame](sensor_msgs::Image* image) {
    image->header.frame_id = frame;
    return kComes;
  };
  vehicle.info = [frame](sensor_msgs::CameraInfo* info) {
    info->header.frame_id = frame;
    return kComes;
  };
  return vehicle;
}

TEST(PlaceChecksTest, FindABodyFrameUsedAsOptical) {
  SeenVehicle vehicle = withFrame("camera_link");
  vehicle.static_transforms = {
      transformOf("base_link", "camera_link", turned(15.0, Vector3d::UnitY()), {0.1, 0.0, 0.05}),
      transformOf("camera_link", "camera_optical", opticalRotation(), Vector3d::Zero())};
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"'camera_link'", "body frame", "look up", "the optical frame, 'camera_optical'"});
  const NodeConfig& node = diagnosis.setup.node;
  ASSERT_EQ(node.extrinsics, ExtrinsicsSource::kParameter);
  const Eigen::Isometry3d T_B_C = node.parameterExtrinsics();
  EXPECT_TRUE(T_B_C.translation().isApprox(Vector3d(0.1, 0.0, 0.05), 1e-5));
  const Vector3d view = turned(15.0, Vector3d::UnitY()) * Vector3d::UnitX();
  EXPECT_TRUE(T_B_C.linear().col(2).isApprox(view, 1e-5)) << T_B_C.matrix();
  expectContains(launchLine(diagnosis), "extrinsic_translation: [0.1, 0, 0.05]");
}

TEST(PlaceChecksTest, FindThatThereIsNoTf) {
  SeenVehicle vehicle;
  vehicle.static_transforms.clear();
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"'camera_optical' is on the body 'base_link': there is no TF",
                 "static_transform_publisher X Y Z -0.5 0.5 -0.5 0.5 base_link camera_optical"});
  expectContains(launchLine(diagnosis),
                 "parameters:={extrinsic_rotation: [-0.5, 0.5, -0.5, 0.5], "
                 "extrinsic_translation: [0, 0, 0], extrinsics: parameter}");
}

TEST(PlaceChecksTest, FindASensorThatTfDoesNotKnow) {
  SeenVehicle vehicle;
  vehicle.static_transforms = {transformOf("base_link", "imu", Quaterniond::Identity())};
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"'camera_optical' is on the body 'base_link' (TF: base_link -> imu)"});
}

TEST(PlaceChecksTest, FindABodyThatTfDoesNotKnow) {
  SeenVehicle vehicle;
  vehicle.static_transforms = {
      transformOf("camera_link", "camera_optical", opticalRotation(), Vector3d::Zero())};
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"body of the poses is 'base_link'", "does not know it", "hangs on 'camera_link'",
                 "static_transform_publisher X Y Z 0 0 0 1 base_link camera_link"});
  expectContains(launchLine(diagnosis), "map_frame:=world body_frame:=camera_link");
  EXPECT_EQ(diagnosis.trial.usable, 30u);
}

TEST(PlaceChecksTest, FindABodyThatIsNotConnected) {
  SeenVehicle vehicle;
  vehicle.static_transforms = {
      transformOf("camera_link", "camera_optical", opticalRotation(), Vector3d::Zero()),
      transformOf("base_link", "imu", Quaterniond::Identity())};
  expectFinding(vehicle.diagnosis(), Severity::kError, {"does not connect it", "'camera_link'"});
}

TEST(PlaceChecksTest, NameTheBodyThatOdometryDoesNot) {
  SeenVehicle vehicle;
  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->child_frame_id.clear();
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"child_frame_id is empty", "body_frame: base_link"});
  expectContains(launchLine(diagnosis), "map_frame:=world body_frame:=base_link");
  EXPECT_EQ(diagnosis.trial.usable, 30u);
}

TEST(PlaceChecksTest, NameTheBodyOfPoseStamped) {
  SeenVehicle vehicle;
  vehicle.pose_topic = "/mavros/local_position/pose";
  vehicle.pose_type = "geometry_msgs/PoseStamped";
  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->child_frame_id.clear();
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectNothingWrong(diagnosis);
  expectContains(launchLine(diagnosis),
                 "pose_source:=pose pose:=/mavros/local_position/pose "
                 "map_frame:=world body_frame:=base_link");
}

TEST(PlaceChecksTest, FindMessagesWithoutFrame) {
  const Diagnosis diagnosis = withFrame("").diagnosis();
  expectFinding(diagnosis, Severity::kError, {"name no frame"});
  expectContains(launchLine(diagnosis), "extrinsics: parameter");
}

}  // namespace
}  // namespace fiimap
