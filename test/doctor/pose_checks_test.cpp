// Poses: that there are some, that they are some, their frame.

#include <cmath>

#include "doctor/mount.h"
#include "seen_vehicle.h"

namespace fiimap {
namespace {

TEST(PoseChecksTest, MissPoses) {
  SeenVehicle vehicle;
  vehicle.pose = [](auto*) { return !kComes; };
  vehicle.more = [](Observation* seen) {
    seen->types["/vio/pose_cov"] = "geometry_msgs/PoseWithCovarianceStamped";
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"There are no poses", "base_link -> camera_optical", "does not read",
                 "/vio/pose_cov (geometry_msgs/PoseWithCovarianceStamped)"});
  EXPECT_TRUE(diagnosis.launch_words.empty());
}

TEST(PoseChecksTest, NameSilentPoses) {
  SeenVehicle vehicle;
  vehicle.pose = [](auto*) { return !kComes; };
  vehicle.more = [](Observation* seen) { seen->types["/vio/odometry"] = "nav_msgs/Odometry"; };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"no message came on /vio/odometry in 3.0 s"});
}

TEST(PoseChecksTest, TakeNoTargetForAPose) {
  SeenVehicle vehicle;
  vehicle.pose_topic = "/mavros/setpoint_position/local";
  vehicle.pose_type = "geometry_msgs/PoseStamped";
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"targets are no poses: /mavros/setpoint_position/local"});
}

TEST(PoseChecksTest, TakePosesFromTf) {
  SeenVehicle vehicle;
  vehicle.pose = [](auto*) { return !kComes; };
  vehicle.pose_on_tf = true;
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote, {"Poses come from TF", "in 'world'"});
  expectContains(launchLine(diagnosis), "pose_source:=tf map_frame:=world body_frame:=base_link");
  EXPECT_GT(diagnosis.trial.usable, 25u);
}

TEST(PoseChecksTest, PreferOdomToMapOnTf) {
  SeenVehicle vehicle;
  vehicle.pose = [](auto*) { return !kComes; };
  vehicle.pose_on_tf = true;
  vehicle.more = [](Observation* seen) {
    for (auto& received : seen->tf) {
      auto message = boost::make_shared<tf2_msgs::TFMessage>(*received.message);
      message->transforms.front().header.frame_id = "odom";
      auto correction = message->transforms.front();  // moves too
      correction.header.frame_id = "map";
      correction.child_frame_id = "odom";
      message->transforms.push_back(correction);
      received.message = message;
    }
  };
  EXPECT_EQ(vehicle.diagnosis().setup.node.map_frame, "odom");
}

TEST(PoseChecksTest, FindPosesThatAreNone) {
  SeenVehicle vehicle;
  int count = 0;
  vehicle.pose = [&count](geometry_msgs::TransformStamped* pose) {
    if (count++ % 3 == 0) pose->transform.rotation.w = 0.0;
    return kComes;
  };
  const Diagnosis zero = vehicle.diagnosis();
  expectFinding(zero, Severity::kError, {"100 of 300 poses", "quaternion has norm 0.0"});
  EXPECT_TRUE(zero.launch_words.empty());

  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->transform.translation.x = std::nan("");
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"300 of 300 poses", "not finite"});
}

TEST(PoseChecksTest, FindTransformsThatAreNone) {
  SeenVehicle vehicle;
  vehicle.static_transforms.push_back(transformOf("base_link", "imu", {0.0, 0.0, 0.0, 0.0}));
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"1 transforms of TF are none", "'base_link' -> 'imu'", "norm 0.0"});
}

TEST(PoseChecksTest, FollowTheFrameOfThePoses) {
  SeenVehicle vehicle;
  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->header.frame_id = "/odom";
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote, {"'odom'", "default 'world'"});
  expectContains(launchLine(diagnosis), "map_frame:=odom");

  DoctorWishes wishes;
  wishes.parameters["map_frame"] = "map";
  const Diagnosis mismatch = vehicle.diagnosis(wishes);
  expectFinding(mismatch, Severity::kError,
                {"in the frame 'odom', but map_frame is 'map'", "map_frame:=odom"});
  expectContains(launchLine(mismatch), "map_frame:=odom");
}

TEST(PoseChecksTest, FindPosesWithoutFrame) {
  SeenVehicle vehicle;
  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->header.frame_id.clear();
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"header.frame_id is empty"});
}

TEST(PoseChecksTest, PreferPosesThatLeadToTheSensor) {
  SeenVehicle vehicle;
  SeenVehicle other;
  other.pose_topic = "/a_wheel/odom";
  other.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->child_frame_id = "wheel";
    return kComes;
  };
  const Observation of_other = other.observation();
  vehicle.more = [&of_other](Observation* seen) {
    seen->poses.insert(of_other.poses.begin(), of_other.poses.end());
    seen->types["/a_wheel/odom"] = "nav_msgs/Odometry";
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.poses, "/odom");
  expectFinding(diagnosis, Severity::kNote, {"Of several topics of poses", "--odom TOPIC"});
}

/// A vehicle with local poses of a type, and MAVROS's global ones.
struct LocalAndGlobal {
  SeenVehicle vehicle, global;

  explicit LocalAndGlobal(const std::string& local_topic, const std::string& local_type) {
    vehicle.pose_topic = local_topic;
    vehicle.pose_type = local_type;
    vehicle.pose_rate = 30.0;
    global.pose_topic = "/mavros/global_position/local";
  }

  Diagnosis diagnosis(const DoctorWishes& wishes = {}, const RunningMap* map = nullptr) {
    const Observation of_global = global.observation();
    vehicle.more = [&of_global, map](Observation* seen) {
      seen->poses.insert(of_global.poses.begin(), of_global.poses.end());
      seen->types["/mavros/global_position/local"] = "nav_msgs/Odometry";
      if (map != nullptr) seen->map = *map;
    };
    return vehicle.diagnosis(wishes);
  }
};

TEST(PoseChecksTest, PreferLocalPosesToGlobalOnes) {
  LocalAndGlobal seen("/mavros/local_position/odom", "nav_msgs/Odometry");
  const Diagnosis diagnosis = seen.diagnosis();
  EXPECT_EQ(diagnosis.setup.poses, "/mavros/local_position/odom");
  expectFinding(diagnosis, Severity::kNote,
                {"from /mavros/local_position/odom, not from /mavros/global_position/local",
                 "GPS, which jumps"});
  // Of another type, which goes after odometry else.
  LocalAndGlobal other("/mavros/local_position/pose", "geometry_msgs/PoseStamped");
  EXPECT_EQ(other.diagnosis().setup.poses, "/mavros/local_position/pose");
  DoctorWishes wishes;
  wishes.odom = "/mavros/global_position/local";
  EXPECT_EQ(other.diagnosis(wishes).setup.poses, "/mavros/global_position/local");
}

TEST(PoseChecksTest, TakeGlobalPosesWhereThereAreNoOthers) {
  SeenVehicle vehicle;
  vehicle.pose_topic = "/mavros/global_position/local";
  const Diagnosis diagnosis = vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.poses, "/mavros/global_position/local");
  expectNothingWrong(diagnosis);
}

TEST(PoseChecksTest, WonderAtAMapOfGlobalPoses) {
  LocalAndGlobal seen("/mavros/local_position/odom", "nav_msgs/Odometry");
  RunningMap map;
  map.name = "/fiimap";
  map.inputs = {{"/mavros/global_position/local", "nav_msgs/Odometry"}};
  const Diagnosis diagnosis = seen.diagnosis({}, &map);
  EXPECT_EQ(diagnosis.setup.poses, "/mavros/global_position/local");
  expectFinding(diagnosis, Severity::kWarning,
                {"although there is /mavros/local_position/odom", "Take the local ones"});
}

TEST(PoseChecksTest, RefuseWishesThatCannotBe) {
  DoctorWishes wishes;
  wishes.odom = "/nowhere";
  EXPECT_THROW(SeenVehicle().diagnosis(wishes), std::invalid_argument);
  wishes = {};
  wishes.parameters["resolutoin"] = "0.1";
  EXPECT_THROW(SeenVehicle().diagnosis(wishes), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
