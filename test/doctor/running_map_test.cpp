// The line for a map that runs: its sensors, its parameters, its name and its manager stay.

#include "doctor/mount.h"
#include "seen_vehicle.h"

namespace fiimap {
namespace {

/// A camera and a LiDAR, and a map that hears both.
struct MapOfTwo {
  SeenVehicle vehicle;
  RunningMap map;

  MapOfTwo() {
    vehicle.image_topic = "/d435/depth/image";
    vehicle.info_topic = "/d435/depth/camera_info";
    vehicle.cloud = [](auto*) { return kComes; };
    vehicle.cloud_topic = "/os/points";
    vehicle.static_transforms.push_back(
        transformOf("base_link", "lidar", Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.3}));
    map.name = "/fiimap";
    map.parameters = {{"sensors", "front top"}, {"top/sensor", "points"},
                      {"max_depth", "5"},       {"top/max_ray_length", "30"},
                      {"p_hit", "0.65"},        {"map_frame", "world"}};
    map.inputs = {{"/d435/depth/image", "sensor_msgs/Image"},
                  {"/d435/depth/camera_info", "sensor_msgs/CameraInfo"},
                  {"/os/points", "sensor_msgs/PointCloud2"},
                  {"/odom", "nav_msgs/Odometry"}};
    map.sensors = {{"front", {"/d435/depth/image", "/d435/depth/camera_info"}},
                   {"top", {"/os/points", ""}}};
  }

  Diagnosis diagnosis() { return diagnose(observation(), {}); }
  std::string text() { return toText(diagnosis(), observation()); }

  Observation observation() {
    vehicle.more = [this](Observation* seen) { seen->map = map; };
    return vehicle.observation();
  }
};

TEST(RunningMapTest, LooksAtEverySensor) {
  MapOfTwo seen;
  const Diagnosis diagnosis = seen.diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote,
                {"'front' (depth images on /d435/depth/image), 'top' (clouds on /os/points)"});
  ASSERT_EQ(diagnosis.trials.size(), 2u);
  EXPECT_GT(diagnosis.trials[0].usable, 25u);
  EXPECT_GT(diagnosis.trials[1].usable, 25u);
}

TEST(RunningMapTest, NamesTheSensorThatIsWrong) {
  MapOfTwo seen;
  seen.vehicle.image = [](sensor_msgs::Image* image) {
    fillImage(0.0, "16UC1", image);
    return kComes;
  };
  expectFinding(seen.diagnosis(), Severity::kError, {"front: No pixel of /d435/depth/image"});
}

TEST(RunningMapTest, FindsTheTopicThatASensorDoesNotHear) {
  MapOfTwo seen;
  seen.map.sensors["top"].scans = "/top/points";
  const Diagnosis diagnosis = seen.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"listens to /top/points, which nobody publishes, for its sensor 'top'; found: "
                 "/os/points",
                 "top/points=/os/points"});
  expectContains(launchLine(diagnosis),
                 "topics:=front/depth/image=/d435/depth/image "
                 "front/depth/camera_info=/d435/depth/camera_info top/points=/os/points");
}

TEST(RunningMapTest, GoesOnWithoutASensorThatIsSilent) {
  MapOfTwo seen;
  seen.vehicle.cloud = [](auto*) { return !kComes; };
  seen.map.errors = {"top: no scans received on /os/points"};
  const Diagnosis diagnosis = seen.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"top: No message came on /os/points", "nobody publishes it"});
  EXPECT_EQ(launchLine(diagnosis), "");
  expectContains(seen.text(), "The map that runs need not end: it goes on without top until");
  EXPECT_EQ(seen.text().find("rosnode kill"), std::string::npos);
  EXPECT_EQ(seen.text().find("launch line leaves out"), std::string::npos);
}

TEST(RunningMapTest, EndsForAnotherSetup) {
  MapOfTwo seen;
  seen.vehicle.cloud = [](auto*) { return !kComes; };
  seen.map.parameters["map_frame"] = "map";
  const Diagnosis diagnosis = seen.diagnosis();
  expectContains(launchLine(diagnosis), "sensors: [front]");
  expectFinding(diagnosis, Severity::kNote, {"launch line leaves out top until"});
  expectContains(seen.text(), "rosnode kill /fiimap");
}

TEST(RunningMapTest, HasNoLineWhereNoSensorWorks) {
  MapOfTwo seen;
  seen.vehicle.cloud = [](auto*) { return !kComes; };
  seen.vehicle.info = [](auto*) { return !kComes; };
  EXPECT_EQ(launchLine(seen.diagnosis()), "");
  expectContains(seen.text(), "No launch line would lead to a map yet");
}

TEST(RunningMapTest, KnowsTheNamesOfTopicsWithoutDiagnostics) {
  MapOfTwo seen;
  seen.map.sensors.clear();
  seen.map.name = "/drone/fiimap";
  seen.vehicle.cloud_topic = "/drone/top/points";
  seen.vehicle.image_topic = "/drone/front/depth/image";
  seen.vehicle.info_topic = "/drone/front/depth/camera_info";
  seen.map.inputs = {{"/drone/front/depth/image", "sensor_msgs/Image"},
                     {"/drone/front/depth/camera_info", "sensor_msgs/CameraInfo"},
                     {"/drone/top/points", "sensor_msgs/PointCloud2"},
                     {"/odom", "nav_msgs/Odometry"}};
  expectNothingWrong(seen.diagnosis());
}

TEST(RunningMapTest, KeepsItsParameters) {
  MapOfTwo seen;
  seen.map.parameters["map_frame"] = "map";  // wrong, so that there is a line
  seen.map.parameters["top/extrinsics"] = "parameter";
  seen.map.parameters["top/extrinsic_translation"] = "0 0 0.3";
  seen.vehicle.static_transforms.pop_back();
  const Diagnosis diagnosis = seen.diagnosis();
  expectContains(launchLine(diagnosis),
                 "parameters:={max_depth: 5, sensors: [front, top], top: {extrinsic_translation: "
                 "[0, 0, 0.3], extrinsics: parameter, max_ray_length: 30, sensor: points}}");
  EXPECT_EQ(diagnosis.kept,
            (std::vector<std::string>{"max_depth", "sensors", "top/extrinsic_translation",
                                      "top/extrinsics", "top/max_ray_length", "top/sensor"}));
  expectContains(seen.text(), "The line keeps what /fiimap has set: max_depth, sensors");
}

TEST(RunningMapTest, KeepsTheParametersOfOneSensor) {
  SeenVehicle vehicle;
  RunningMap map;
  map.name = "/fiimap";
  map.parameters = {{"extrinsics", "parameter"},
                    {"extrinsic_translation", "0.1 0 0"},
                    {"extrinsic_rotation", "-0.5 0.5 -0.5 0.5"},
                    {"max_pose_gap", "0.2"},
                    {"save_directory", "/my \"maps\""},
                    {"body_frame", "base_link"},
                    {"map_frame", "map"}};
  map.inputs = {{"/odom", "nav_msgs/Odometry"}};
  vehicle.more = [&map](Observation* seen) { seen->map = map; };
  const std::string line = launchLine(vehicle.diagnosis());
  expectContains(line, "map_frame:=world body_frame:=base_link");
  expectContains(line,
                 "parameters:={extrinsic_rotation: [-0.5, 0.5, -0.5, 0.5], "
                 "extrinsic_translation: [0.1, 0, 0], extrinsics: parameter, max_pose_gap: 0.2, "
                 "save_directory: \"/my \\\"maps\\\"\"}");
}

TEST(RunningMapTest, KeepsNamespaceAndManager) {
  MapOfTwo seen;
  seen.map.name = "/drone1/map";
  seen.map.manager = "/drone1/manager";
  seen.map.parameters["map_frame"] = "map";
  expectContains(launchLine(seen.diagnosis()),
                 "mapping.launch __ns:=/drone1 name:=map manager:=/drone1/manager sensor:=depth");
  seen.map.name = "/drone1/fiimap";
  seen.map.manager.clear();
  expectContains(launchLine(seen.diagnosis()), "mapping.launch __ns:=/drone1 sensor:=depth");
}

}  // namespace
}  // namespace fiimap
