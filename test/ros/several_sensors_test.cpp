// Several sensors through one ScanSynchronizer.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/scan_synchronizer.h"
#include "messages.h"

namespace fiimap {
namespace {

constexpr std::size_t kFront = 0, kLeft = 1, kLidar = 2;

/// Writes down what it hears: the sensor's number, then '+' for a scan or the reason of a drop.
class SensorDiary : public ScanListener {
 public:
  void onScan(const SynchronizedScan& scan) override {
    scans.push_back(scan);
    events.push_back(std::to_string(scan.sensor) + '+');
  }
  void onDrop(const Drop& drop, std::size_t sensor) override {
    events.push_back(std::to_string(sensor) + ' ' + nameOf(drop.reason));
  }
  void onTimeJump(const std::string& what) override {
    events.push_back("jump");
    jump = what;
  }
  void onWarning(const std::string& text) override { warnings.push_back(text); }

  std::vector<SynchronizedScan> scans;
  std::vector<std::string> events, warnings;
  std::string jump;
};

using Events = std::vector<std::string>;

SensorConfig sensorAt(const std::string& name, SensorKind kind, double x) {
  SensorConfig sensor;
  sensor.name = name;
  sensor.sensor = kind;
  sensor.extrinsics = ExtrinsicsSource::kParameter;
  sensor.extrinsic_translation.x() = x;
  return sensor;
}

NodeConfig threeSensors() {
  NodeConfig config;
  config.pose_source = PoseSource::kTransform;
  config.sensors = {sensorAt("front", SensorKind::kDepth, 0.1),
                    sensorAt("left", SensorKind::kDepth, 0.2),
                    sensorAt("lidar", SensorKind::kPoints, 0.3)};
  return config;
}

class SeveralSensorsTest : public testing::Test {
 protected:
  SeveralSensorsTest() { useConfig(threeSensors()); }
  void useConfig(const NodeConfig& config) { synchronizer_.emplace(config, &diary_); }
  void addPose(double seconds) { synchronizer_->add(transformAt(seconds, seconds)); }
  void addPoses(double from, double to) {
    for (double seconds = from; seconds < to; seconds += 0.05) addPose(seconds);
  }
  void addScan(std::size_t sensor, double seconds, const Moment& received = Moment()) {
    if (sensor == kLidar) {
      const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
      cloud->header.stamp = at(seconds);
      synchronizer_->add(sensor_msgs::PointCloud2ConstPtr(cloud), received, sensor);
      return;
    }
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = at(seconds);
    image->width = image->height = 4;
    synchronizer_->add(sensor_msgs::ImageConstPtr(image), received, sensor);
  }
  void addInfo(std::size_t sensor, double focal_length) {
    const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    info->width = info->height = 4;
    info->K = {focal_length, 0.0, 2.0, 0.0, focal_length, 2.0, 0.0, 0.0, 1.0};
    synchronizer_->add(sensor_msgs::CameraInfoConstPtr(info), sensor);
  }
  void addBothInfos() {
    addInfo(kFront, 4.0);
    addInfo(kLeft, 5.0);
  }

  SensorDiary diary_;
  std::optional<ScanSynchronizer> synchronizer_;
};

TEST_F(SeveralSensorsTest, EachScanHasTheExtrinsicsAndIntrinsicsOfItsSensor) {
  addPoses(0.0, 0.5);
  addBothInfos();
  for (const std::size_t sensor : {kFront, kLeft, kLidar}) addScan(sensor, 0.1);
  ASSERT_EQ(diary_.events, (Events{"0+", "1+", "2+"}));
  for (const std::size_t sensor : {kFront, kLeft, kLidar}) {
    EXPECT_NEAR(diary_.scans[sensor].pose.T_W_S.translation().x(), 0.1 + 0.1 * (sensor + 1), 1e-6);
    EXPECT_NEAR(diary_.scans[sensor].T_W_B.translation().x(), 0.1, 1e-6);
  }
  EXPECT_DOUBLE_EQ(diary_.scans[kFront].intrinsics.fx, 4.0);
  EXPECT_DOUBLE_EQ(diary_.scans[kLeft].intrinsics.fx, 5.0);
}

TEST_F(SeveralSensorsTest, EachHasItsOwnTimeOffset) {
  NodeConfig config = threeSensors();
  config.sensors[kLidar].time_offset = -0.2;
  useConfig(config);
  addBothInfos();
  addPoses(0.0, 0.5);
  for (const std::size_t sensor : {kFront, kLidar}) addScan(sensor, 0.3);
  ASSERT_EQ(diary_.scans.size(), 2u);
  EXPECT_NEAR(diary_.scans[0].T_W_B.translation().x(), 0.3, 1e-6);
  EXPECT_NEAR(diary_.scans[1].T_W_B.translation().x(), 0.1, 1e-6);
}

TEST_F(SeveralSensorsTest, StampsOfDifferentSensorsMayGoBackAndForth) {
  addPoses(0.0, 3.0);
  addBothInfos();
  for (const double seconds : {0.5, 1.0, 1.5, 2.0}) {
    addScan(kFront, seconds);
    addScan(kLidar, seconds - 0.4);
    addScan(kLeft, seconds);  // the same stamp as another
  }
  EXPECT_EQ(std::count(diary_.events.begin(), diary_.events.end(), "2+"), 4);
  EXPECT_EQ(diary_.scans.size(), 12u);
  addScan(kLidar, 1.6);  // not newer than its own
  EXPECT_EQ(diary_.events.back(), "2 stale_stamp");
}

TEST_F(SeveralSensorsTest, WhatIsReadyAtOnceGoesByItsStamp) {
  addPose(0.0);
  addBothInfos();
  addScan(kLidar, 0.03);
  addScan(kLeft, 0.01);
  addScan(kFront, 0.02);
  addScan(kLeft, 0.04);
  EXPECT_TRUE(diary_.events.empty());
  addPose(0.05);
  EXPECT_EQ(diary_.events, (Events{"1+", "0+", "2+", "1+"}));
}

TEST_F(SeveralSensorsTest, ASensorThatLacksSomethingHoldsUpNoOther) {
  addPoses(0.0, 2.0);
  addInfo(kFront, 4.0);
  addScan(kLeft, 0.1);  // without its camera_info
  addScan(kFront, 0.2);
  addScan(kLidar, 0.3);
  EXPECT_EQ(diary_.events, (Events{"0+", "2+"}));
  EXPECT_EQ(synchronizer_->waiting(kLeft), 1u);
  EXPECT_EQ(synchronizer_->waiting(kFront), 0u);
  for (const double seconds : {0.6, 0.9, 1.2}) addScan(kFront, seconds);
  EXPECT_EQ(synchronizer_->waiting(kLeft), 1u);  // others do not tell its time
  addScan(kLeft, 0.7);
  EXPECT_EQ(diary_.events.back(), "1 no_camera_info");
}

TEST_F(SeveralSensorsTest, TheQueuesAreBoundedEachByItself) {
  NodeConfig config = threeSensors();
  config.scan_queue_size = 3;
  useConfig(config);
  addBothInfos();
  addPose(0.0);
  addScan(kLidar, 0.001);
  for (int i = 1; i <= 5; ++i) addScan(kFront, 0.01 * i);
  EXPECT_EQ(diary_.events, (Events{"0 queue_full", "0 queue_full"}));
  EXPECT_EQ(synchronizer_->waiting(kLidar), 1u);
  addPose(0.06);
  EXPECT_EQ(diary_.events[2], "2+");
}

TEST_F(SeveralSensorsTest, WaitingScansOfAllExpire) {
  const auto moment = [](double seconds) {
    const std::chrono::duration<double> since_start(seconds);
    return Moment{at(seconds),
                  std::chrono::steady_clock::time_point() +
                      std::chrono::duration_cast<std::chrono::nanoseconds>(since_start)};
  };
  addBothInfos();
  addPose(0.0);
  addScan(kLidar, 0.01, moment(0.0));
  addScan(kFront, 0.01, moment(0.3));
  synchronizer_->expire(moment(0.6));
  EXPECT_EQ(diary_.events, Events{"2 pose_timeout"});
  synchronizer_->expire(moment(0.9));
  EXPECT_EQ(diary_.events, (Events{"2 pose_timeout", "0 pose_timeout"}));
}

TEST_F(SeveralSensorsTest, ALoopingBagStartsAnewOnce) {
  addBothInfos();
  for (int round = 0; round < 3; ++round) {
    diary_ = SensorDiary();
    for (int i = 0; i < 200; ++i) {
      const double now = 10.0 + 0.01 * i;
      addPose(now);
      if (i % 3 == 0) addScan(kFront, now - 0.005);
      if (i % 3 == 1) addScan(kLeft, now - 0.015);
      if (i % 10 == 5) addScan(kLidar, now - 0.02);
    }
    EXPECT_EQ(std::count(diary_.events.begin(), diary_.events.end(), "jump"), round > 0) << round;
    EXPECT_GT(diary_.scans.size(), 145u);
    for (const std::size_t sensor : {kFront, kLeft, kLidar}) {
      EXPECT_LE(synchronizer_->waiting(sensor), 1u);
    }
  }
}

TEST_F(SeveralSensorsTest, ScansAloneTellOfALoopingBagOnceAndWhose) {
  addBothInfos();
  addPoses(10.0, 11.5);
  for (const std::size_t sensor : {kFront, kLidar}) addScan(sensor, 11.0);
  const std::size_t before = diary_.events.size();
  addScan(kLidar, 1.0);
  for (const double seconds : {1.0, 1.05}) addScan(kFront, seconds);
  addScan(kLidar, 1.1);
  EXPECT_EQ(diary_.events.size(), before + 1);
  EXPECT_EQ(diary_.events.back(), "jump");
  EXPECT_EQ(diary_.jump.find("the stamps of the scans of front went back by"), 0u) << diary_.jump;
  EXPECT_EQ(synchronizer_->waiting(kFront), 2u);
  EXPECT_EQ(synchronizer_->waiting(kLidar), 2u);
  addPoses(0.9, 1.3);
  EXPECT_EQ(diary_.scans.size(), 6u);
}

TEST_F(SeveralSensorsTest, AWrongStampOfOneCostsTheOthersNothing) {
  addPoses(0.0, 0.5);
  addBothInfos();
  for (const std::size_t sensor : {kFront, kLidar}) addScan(sensor, 0.1);
  addScan(kLidar, 900.0);
  for (const std::size_t sensor : {kFront, kLidar}) addScan(sensor, 0.2);
  EXPECT_EQ(diary_.events, (Events{"0+", "2+", "0+", "2 stale_stamp", "2+"}));
}

TEST_F(SeveralSensorsTest, AWrongFirstStampOfALateSensorCostsTheOthersNothing) {
  addPoses(99.0, 100.0);
  addBothInfos();
  addScan(kFront, 99.5);
  for (const double seconds : {160.0, 99.6, 99.7}) addScan(kLidar, seconds);
  EXPECT_EQ(diary_.events, (Events{"0+", "2 stale_stamp", "2+", "2+"}));
}

TEST_F(SeveralSensorsTest, WithoutPosesTheOtherSensorsTellOfAWrongFirstStamp) {
  addScan(kFront, 100.0);
  for (const double seconds : {160.0, 100.1, 100.2}) addScan(kLidar, seconds);
  EXPECT_EQ(diary_.events, Events{"2 stale_stamp"});
}

TEST_F(SeveralSensorsTest, WhatComesLateFromBeforeAJumpMakesNoOther) {
  addBothInfos();
  addPoses(10.0, 11.5);
  for (const std::size_t sensor : {kFront, kLidar}) addScan(sensor, 11.0);
  for (const double seconds : {1.0, 1.05}) addScan(kFront, seconds);
  addScan(kLidar, 11.1);
  addPose(11.5);
  for (const double seconds : {1.1, 1.15}) addScan(kLidar, seconds);
  addPoses(0.9, 1.3);
  EXPECT_EQ(diary_.events, (Events{"0+", "2+", "jump", "2 stale_stamp", "0+", "0+", "2+", "2+"}));
}

TEST_F(SeveralSensorsTest, AClockFarAheadLeavesTheOthersAndThePosesGuarded) {
  addPoses(0.0, 0.5);
  addBothInfos();
  addScan(kFront, 0.1);
  for (const double seconds : {900.0, 900.1}) addScan(kLidar, seconds);
  for (const double seconds : {500.0, 0.5, 0.55}) addPose(seconds);
  for (const double seconds : {0.2, 500.0, 0.3, 0.4}) addScan(kFront, seconds);
  EXPECT_EQ(diary_.events, (Events{"0+", "0+", "0 stale_stamp", "0+", "0+"}));
  EXPECT_EQ(synchronizer_->waiting(kLidar), 2u);
}

TEST_F(SeveralSensorsTest, WarningsNameTheSensor) {
  addPoses(0.0, 1.0);
  addBothInfos();
  for (int i = 1; i <= 9; ++i) addScan(kLeft, 0.1 * i);
  ASSERT_EQ(diary_.warnings.size(), 1u);
  EXPECT_EQ(diary_.warnings[0].find("left: "), 0u) << diary_.warnings[0];
}

TEST_F(SeveralSensorsTest, EveryScanEndsAsExactlyOneEvent) {
  addInfo(kFront, 4.0);
  std::size_t scans = 0;
  for (int i = 0; i < 3000; ++i) {
    const double now = 0.01 * ((i * 7) % 1600);
    if (i % 3 != 0 && i % 500 < 350) addPose(now + 0.01 * (i % 11));
    if (i == 1500) addInfo(kLeft, 5.0);
    addScan(static_cast<std::size_t>(i * i % 3), now - 0.02 * (i % 5));
    ++scans;
  }
  synchronizer_->finish();
  const auto jumps = std::count(diary_.events.begin(), diary_.events.end(), "jump");
  EXPECT_EQ(diary_.events.size(), scans + static_cast<std::size_t>(jumps));
  EXPECT_GT(diary_.scans.size(), 0u);
}

}  // namespace
}  // namespace fiimap
