// Stamps, rates, clocks.

#include "seen_vehicle.h"

namespace fiimap {
namespace {

TEST(TimeChecksTest, FindSlowPoses) {
  SeenVehicle vehicle;
  vehicle.pose_rate = 2.0;
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"/odom come at 2.0 Hz", "0.50 s apart", "max_pose_gap, 0.10 s"});
  expectContains(launchLine(diagnosis), "max_pose_gap: 0.75, max_pose_wait: 0.75");
  EXPECT_GT(diagnosis.trial.usable, 10u);  // the line does what it says
}

TEST(TimeChecksTest, OnlyNoteASingleGapOfPoses) {
  SeenVehicle vehicle;
  int count = 0;
  vehicle.pose = [&count](auto*) { return count++ < 100 || count > 120; };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kNote, {"longest gap", "0.21 s", "max_pose_gap"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(TimeChecksTest, FindSlowScans) {
  SeenVehicle vehicle;
  vehicle.image_rate = 1.0;
  expectFinding(vehicle.diagnosis(), Severity::kWarning, {"Scans come at 1.0 Hz"});
}

TEST(TimeChecksTest, WonderAtStampsThatAreApart) {
  SeenVehicle vehicle;
  vehicle.image_delay = 0.2;
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kWarning,
                {"0.198 s apart", "scans arrive 0.200 s", "poses 0.002 s", "time_offset"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(TimeChecksTest, FindPosesThatComeTooLate) {
  SeenVehicle vehicle;
  vehicle.pose_delay = 0.75;
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"Poses come 0.70 s later", "max_pose_wait, 0.50 s"});
  expectContains(launchLine(diagnosis), "max_pose_wait: 1.05");
}

TEST(TimeChecksTest, FindDifferentClocks) {
  SeenVehicle vehicle;
  // The camera's clock is 40 s behind: its messages arrive 40 s after their stamps.
  vehicle.image_delay = 0.05;
  vehicle.image = [](sensor_msgs::Image* image) {
    image->header.stamp -= ros::Duration(40.0);
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"different clocks", "40.050 s", "40.048 s"});
  expectContains(launchLine(diagnosis), "time_offset: 40.048");
  EXPECT_GT(diagnosis.trial.usable, 25u);
}

TEST(TimeChecksTest, MissStamps) {
  SeenVehicle vehicle;
  vehicle.image = [](sensor_msgs::Image* image) {
    image->header.stamp = ros::Time();
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"30 of 30 messages", "have no stamp"});
}

TEST(TimeChecksTest, FindThatSimulatedTimeWasForgotten) {
  SeenVehicle vehicle;
  vehicle.more = [](Observation* seen) {
    seen->types["/clock"] = "rosgraph_msgs/Clock";
    seen->clock_messages = 100;
  };
  const Observation seen = vehicle.observation();
  const Diagnosis diagnosis = diagnose(seen, {});
  expectFinding(diagnosis, Severity::kError, {"/use_sim_time is not set", "rosparam set"});
  expectContains(toText(diagnosis, seen), "\nrosparam set /use_sim_time true\nroslaunch ");
}

TEST(TimeChecksTest, FindThatSimulatedTimeDoesNotPass) {
  SeenVehicle vehicle;
  vehicle.more = [](Observation* seen) { seen->use_sim_time = true; };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"/use_sim_time is true, but no time comes on /clock"});
  vehicle.more = [](Observation* seen) {
    seen->use_sim_time = true;
    seen->clock_messages = 100;
  };
  expectNothingWrong(vehicle.diagnosis());
}

TEST(TimeChecksTest, WonderAtStampsInTheFuture) {
  SeenVehicle vehicle;
  vehicle.image_delay = -0.3;
  vehicle.pose_delay = -0.35;
  expectFinding(vehicle.diagnosis(), Severity::kWarning, {"Stamps lie 0.35 s in the future"});
}

TEST(TimeChecksTest, WonderAtRecordingsPlayedWithoutClock) {
  SeenVehicle vehicle;
  vehicle.image_delay = 1000.05;
  vehicle.pose_delay = 1000.0;
  expectFinding(vehicle.diagnosis(), Severity::kWarning, {"1000 s behind", "--clock"});
  vehicle.more = [](Observation* seen) { seen->bag = "/a.bag"; };
  expectNothingWrong(vehicle.diagnosis());
}

}  // namespace
}  // namespace fiimap
