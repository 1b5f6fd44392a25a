// A mapping node that runs is looked at with its own parameters and topics.

#include "seen_vehicle.h"

namespace fiimap {
namespace {

/// A vehicle and a map that hears all of it.
struct SeenMap {
  SeenVehicle vehicle;
  RunningMap map;

  SeenMap() {
    map.name = "/fiimap";
    map.parameters = {{"pose_source", "odometry"}, {"sensor", "depth"}, {"map_frame", "world"}};
    map.inputs = {{"/camera/depth/image_rect_raw", "sensor_msgs/Image"},
                  {"/camera/depth/camera_info", "sensor_msgs/CameraInfo"},
                  {"/odom", "nav_msgs/Odometry"}};
    vehicle.more = [this](Observation* seen) { seen->map = map; };
  }
};

TEST(MapChecksTest, FindNothingWrongWithAMapThatHearsAll) {
  SeenMap seen;
  expectNothingWrong(seen.vehicle.diagnosis());
  const Observation observation = seen.vehicle.observation();
  expectContains(toText(diagnose(observation, {}), observation),
                 "The map that runs has what it needs.");
}

TEST(MapChecksTest, LookAtAllThatANodeletManagerHears) {
  SeenMap seen;
  // Of other nodelets; they come first in the alphabet.
  seen.map.inputs["/a/camera/image"] = "sensor_msgs/Image";
  seen.map.inputs["/a/camera/camera_info"] = "sensor_msgs/CameraInfo";
  seen.map.inputs["/a/odom"] = "nav_msgs/Odometry";
  expectNothingWrong(seen.vehicle.diagnosis());
}

TEST(MapChecksTest, FindTopicsThatNobodyPublishes) {
  SeenMap seen;
  seen.map.inputs = {{"/depth/image", "sensor_msgs/Image"},
                     {"/camera/depth/camera_info", "sensor_msgs/CameraInfo"},
                     {"/vio/odom", "nav_msgs/Odometry"}};
  const Diagnosis diagnosis = seen.vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"/fiimap listens to /depth/image for depth images, which nobody publishes",
                 "depth_image:=/camera/depth/image_rect_raw"});
  expectFinding(diagnosis, Severity::kError, {"/vio/odom", "odom:=/odom"});
  EXPECT_FALSE(diagnosis.launch_words.empty());
}

TEST(MapChecksTest, HoldTheMapToItsOwnParameters) {
  SeenMap seen;
  seen.map.parameters["map_frame"] = "map";
  expectFinding(seen.vehicle.diagnosis(), Severity::kError, {"'world', but map_frame is 'map'"});
  seen.map.parameters["map_frame"] = "world";
  seen.map.parameters["depth_scale"] = "0.1";
  expectFinding(seen.vehicle.diagnosis(), Severity::kError, {"another unit", "depth_scale: 0.001"});
  seen.map.parameters["depth_scale"] = "0.001";
  seen.map.parameters["pose_source"] = "transform";
  expectFinding(seen.vehicle.diagnosis(), Severity::kError, {"from another source"});
}

TEST(MapChecksTest, PassOnWhatTheMapSays) {
  SeenMap seen;
  seen.map.errors = {"all scans dropped"};
  expectFinding(seen.vehicle.diagnosis(), Severity::kError, {"says: all scans dropped"});
  seen.map.errors.clear();
  seen.map.warnings = {"the vehicle is inside an obstacle"};
  const Diagnosis diagnosis = seen.vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kWarning, {"inside an obstacle"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(MapChecksTest, TakeNoOutputOfAMapForAnInput) {
  SeenVehicle vehicle;
  vehicle.cloud = [](auto*) { return true; };
  vehicle.cloud_topic = "/fiimap/occupied";
  Observation seen;
  seen.types["/fiimap/map_handle"] = "fiimap/MapInfo";
  EXPECT_TRUE(isOutputOfMap("/fiimap/occupied", seen));
  EXPECT_FALSE(isOutputOfMap("/fiimap2/occupied", seen));
  EXPECT_FALSE(isOutputOfMap("/points", seen));
}

}  // namespace
}  // namespace fiimap
