// The launch line as words and as a shell reads it.

#include "doctor/launch_line.h"

#include "seen_vehicle.h"

namespace fiimap {
namespace {

TEST(LaunchLineTest, NamesAllInputsOfALiveGraph) {
  EXPECT_EQ(launchLine(SeenVehicle().diagnosis()),
            "roslaunch fiimap mapping.launch sensor:=depth "
            "depth_image:=/camera/depth/image_rect_raw camera_info:=/camera/depth/camera_info "
            "pose_source:=odometry odom:=/odom map_frame:=world");
}

TEST(LaunchLineTest, PlaysABagWithoutItsClock) {
  SeenVehicle vehicle;
  vehicle.more = [](Observation* seen) { seen->bag = "/a b/flight.bag"; };
  expectContains(launchLine(vehicle.diagnosis()), "replay.launch bag:=/a b/flight.bag sensor:=");
  vehicle.more = [](Observation* seen) {
    seen->bag = "/flight.bag";
    seen->types["/clock"] = "rosgraph_msgs/Clock";
  };
  expectContains(launchLine(vehicle.diagnosis()),
                 "bag_topics:=/camera/depth/image_rect_raw /camera/depth/camera_info /odom "
                 "/tf_static ");
}

TEST(LaunchLineTest, KeepsWhatTheUserSet) {
  DoctorWishes wishes;
  wishes.parameters = {
      {"resolution", "0.2"}, {"map_frame", "world"}, {"save_directory", "/my maps"}};
  expectContains(launchLine(SeenVehicle().diagnosis(wishes)),
                 "parameters:={resolution: 0.2, save_directory: \"/my maps\"}");
}

TEST(LaunchLineTest, QuotesForTheShell) {
  EXPECT_EQ(shellCommand({"roslaunch", "a:=/b/c.bag", "d:={e: 1}", "f:=it's"}),
            "roslaunch a:=/b/c.bag d:='{e: 1}' f:='it'\\''s'");
}

TEST(LaunchLineTest, WritesNumbersThatYamlReadsAsNumbers) {
  EXPECT_EQ(plainNumber(0.0001), "0.0001");
  EXPECT_EQ(plainNumber(-0.0), "0");
  EXPECT_EQ(plainNumber(1e-9), "0");
  EXPECT_EQ(plainNumber(-0.5), "-0.5");
  EXPECT_EQ(plainNumber(30.0), "30");
}

}  // namespace
}  // namespace fiimap
