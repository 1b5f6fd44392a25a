#include "fiimap/ros/scan_synchronizer.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "messages.h"

namespace fiimap {
namespace {

/// Writes down what it hears, as words.
class Diary : public ScanListener {
 public:
  void onScan(const SynchronizedScan& scan) override {
    scans.push_back(scan);
    events.push_back("scan");
  }
  void onDrop(const Drop& drop, std::size_t sensor) override {
    events.push_back(nameOf(drop.reason));
    dropped_sensors.push_back(sensor);
  }
  void onTimeJump(const std::string&) override { events.push_back("jump"); }
  void onWarning(const std::string& text) override { warnings.push_back(text); }

  std::vector<SynchronizedScan> scans;
  std::vector<std::string> events;
  std::vector<std::size_t> dropped_sensors;
  std::vector<std::string> warnings;
};

using Events = std::vector<std::string>;

NodeConfig cloudConfig() {
  NodeConfig config;
  config.sensor = SensorKind::kPoints;
  config.pose_source = PoseSource::kTransform;
  config.extrinsics = ExtrinsicsSource::kParameter;
  return config;
}

class ScanSynchronizerTest : public testing::Test {
 protected:
  ScanSynchronizerTest() { useConfig(cloudConfig()); }
  void useConfig(const NodeConfig& config) { synchronizer_.emplace(config, &diary_); }
  void addPose(double seconds) { synchronizer_->add(transformAt(seconds, seconds)); }
  void addPoses(double from, double to) {
    for (double seconds = from; seconds < to; seconds += 0.05) addPose(seconds);
  }
  void addCloud(double seconds, const Moment& received = Moment(), std::size_t sensor = 0) {
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
    cloud->header.stamp = at(seconds);
    synchronizer_->add(ScanMessage(sensor_msgs::PointCloud2ConstPtr(cloud)), received, sensor);
  }
  void addImage(double seconds, std::size_t sensor = 0) {
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = at(seconds);
    image->header.frame_id = "camera_link";
    image->width = image->height = 4;
    synchronizer_->add(ScanMessage(sensor_msgs::ImageConstPtr(image)), Moment(), sensor);
  }
  void addCameraInfo(std::uint32_t size = 4, std::size_t sensor = 0) {
    const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    info->width = info->height = size;
    info->K = {4.0, 0.0, 2.0, 0.0, 4.0, 2.0, 0.0, 0.0, 1.0};
    synchronizer_->add(sensor_msgs::CameraInfoConstPtr(info), sensor);
  }

  Diary diary_;
  std::optional<ScanSynchronizer> synchronizer_;
};

TEST_F(ScanSynchronizerTest, GivesALateScanItsPoseAtOnce) {
  addPoses(0.0, 0.5);
  addCloud(0.12);
  ASSERT_EQ(diary_.events, Events{"scan"});
  EXPECT_NEAR(diary_.scans[0].pose.T_W_S.translation().x(), 0.12, 1e-6);
  EXPECT_EQ(diary_.scans[0].pose.stamp_ns, static_cast<std::int64_t>(at(0.12).toNSec()));
  EXPECT_NEAR(diary_.scans[0].pose_gap, 0.05, 1e-6);
}

TEST_F(ScanSynchronizerTest, AnEarlyScanWaitsForThePoseAfterIt) {
  addPose(0.0);
  addCloud(0.02);
  EXPECT_EQ(synchronizer_->waiting(), 1u);
  addPose(0.01);
  EXPECT_TRUE(diary_.events.empty());
  addPose(0.03);
  EXPECT_EQ(diary_.events, Events{"scan"});
  EXPECT_EQ(synchronizer_->waiting(), 0u);
}

TEST_F(ScanSynchronizerTest, KeepsTheOrderOfScans) {
  addPose(0.0);
  for (const double seconds : {0.01, 0.02, 0.03}) addCloud(seconds);
  addPose(0.05);
  ASSERT_EQ(diary_.scans.size(), 3u);
  EXPECT_LT(diary_.scans[0].pose.stamp_ns, diary_.scans[1].pose.stamp_ns);
  EXPECT_LT(diary_.scans[1].pose.stamp_ns, diary_.scans[2].pose.stamp_ns);
}

TEST_F(ScanSynchronizerTest, AddsTheTimeOffsetToScans) {
  NodeConfig config = cloudConfig();
  config.time_offset = -0.25;
  useConfig(config);
  addPoses(0.0, 0.5);
  addCloud(0.5);
  ASSERT_EQ(diary_.scans.size(), 1u);
  EXPECT_NEAR(diary_.scans[0].pose.T_W_S.translation().x(), 0.25, 1e-6);
}

TEST_F(ScanSynchronizerTest, AnotherTimeOffsetHoldsForScansFromThenOnWhicheverWayItGoes) {
  NodeConfig config = cloudConfig();
  addPoses(0.0, 3.0);
  addCloud(1.5);
  std::vector<double> expected = {1.5};
  for (const double offset : {-1.3, 0.2, 0.0}) {
    config.time_offset = offset;
    synchronizer_->reconfigure(config);
    const double stamp = 1.6 + 0.1 * static_cast<double>(expected.size());
    addCloud(stamp);
    expected.push_back(stamp + offset);
  }
  EXPECT_EQ(diary_.events, (Events{"scan", "scan", "scan", "scan"})) << "no time jumped";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(diary_.scans[i].pose.T_W_S.translation().x(), expected[i], 1e-6);
  }
}

TEST_F(ScanSynchronizerTest, TheSameTimeOffsetAgainForgetsNoStamp) {
  addPoses(0.0, 1.0);
  addCloud(0.5);
  synchronizer_->reconfigure(cloudConfig());
  addCloud(0.4);
  EXPECT_EQ(diary_.events, (Events{"scan", "stale_stamp"}));
}

TEST_F(ScanSynchronizerTest, AScanThatWaitsKeepsItsStampWhenTheTimeOffsetChanges) {
  addPoses(0.0, 0.5);
  addCloud(0.7);
  NodeConfig config = cloudConfig();
  config.time_offset = -0.5;
  synchronizer_->reconfigure(config);
  addCloud(0.8);
  EXPECT_TRUE(diary_.events.empty()) << "the scan before it waits for its pose";
  addPoses(0.5, 1.0);
  ASSERT_EQ(diary_.events, (Events{"scan", "scan"}));
  EXPECT_NEAR(diary_.scans[0].pose.T_W_S.translation().x(), 0.7, 1e-6);
  EXPECT_NEAR(diary_.scans[1].pose.T_W_S.translation().x(), 0.3, 1e-6);
}

TEST_F(ScanSynchronizerTest, AnotherGapOrWaitHoldsForScansThatWait) {
  NodeConfig config = cloudConfig();
  config.max_pose_gap = config.max_pose_wait = 1.0;
  useConfig(config);
  addPose(0.0);
  addCloud(0.1);
  config.max_pose_gap = 0.3;
  synchronizer_->reconfigure(config);
  addPose(0.5);
  EXPECT_EQ(diary_.events, Events{"pose_gap"});
  addCloud(0.6);
  config.max_pose_wait = 0.2;
  synchronizer_->reconfigure(config);
  addCloud(0.9);
  EXPECT_EQ(diary_.events, (Events{"pose_gap", "pose_timeout"}));
}

TEST_F(ScanSynchronizerTest, RefusesStampsThatAreZeroOrNotNewer) {
  addPoses(0.0, 0.5);
  const auto cloud = boost::make_shared<const sensor_msgs::PointCloud2>();
  synchronizer_->add(ScanMessage(sensor_msgs::PointCloud2ConstPtr(cloud)));
  addCloud(0.2);
  addCloud(0.2);
  addCloud(0.1);
  addCloud(0.3);
  EXPECT_EQ(diary_.events, (Events{"zero_stamp", "scan", "stale_stamp", "stale_stamp", "scan"}));
}

TEST_F(ScanSynchronizerTest, OdometryThatStopsCostsScansAfterTheWait) {
  addPose(0.0);
  for (const double seconds : {0.2, 0.4, 0.6}) addCloud(seconds);
  EXPECT_TRUE(diary_.events.empty());
  addCloud(0.8);
  EXPECT_EQ(diary_.events, Events{"pose_timeout"});
  addCloud(1.2);
  EXPECT_EQ(diary_.events, (Events{"pose_timeout", "pose_timeout", "pose_timeout"}));
  EXPECT_EQ(synchronizer_->waiting(), 2u);
  addPose(1.18);
  addPose(1.22);
  EXPECT_EQ(diary_.events.back(), "scan");
  EXPECT_EQ(synchronizer_->waiting(), 0u);
}

TEST_F(ScanSynchronizerTest, TheQueueIsBounded) {
  NodeConfig config = cloudConfig();
  config.scan_queue_size = 3;
  useConfig(config);
  addPose(0.0);
  for (int i = 1; i <= 5; ++i) addCloud(0.01 * i);
  EXPECT_EQ(diary_.events, (Events{"queue_full", "queue_full"}));
  EXPECT_EQ(synchronizer_->waiting(), 3u);
}

TEST_F(ScanSynchronizerTest, ExpiresScansAfterTheWaitByBothClocks) {
  const auto moment = [](double ros, double steady) {
    const std::chrono::duration<double> since_start(steady);
    return Moment{at(ros), std::chrono::steady_clock::time_point() +
                               std::chrono::duration_cast<std::chrono::nanoseconds>(since_start)};
  };
  addPose(0.0);
  addCloud(0.01, moment(10.0, 70.0));
  synchronizer_->expire(moment(10.4, 70.4));
  synchronizer_->expire(moment(11.0, 70.4));
  synchronizer_->expire(moment(10.4, 71.0));
  EXPECT_TRUE(diary_.events.empty());
  synchronizer_->expire(moment(10.6, 70.6));
  EXPECT_EQ(diary_.events, Events{"pose_timeout"});
}

TEST_F(ScanSynchronizerTest, FinishDropsWhatStillWaits) {
  addCloud(0.01);
  addCloud(0.02);
  synchronizer_->finish();
  EXPECT_EQ(diary_.events, (Events{"pose_timeout", "pose_timeout"}));
  EXPECT_EQ(synchronizer_->waiting(), 0u);
}

TEST_F(ScanSynchronizerTest, ALoopingBagStartsAnewWhenScansJumpBack) {
  addPoses(2.0, 2.5);
  addCloud(2.2);
  addCloud(2.6);
  addCloud(0.02);
  EXPECT_EQ(diary_.events, Events{"scan"});
  EXPECT_EQ(synchronizer_->waiting(), 2u);
  addCloud(0.04);
  EXPECT_EQ(diary_.events, (Events{"scan", "time_jump", "jump"}));
  EXPECT_EQ(synchronizer_->waiting(), 2u);
  addPoses(0.0, 0.1);
  EXPECT_EQ(diary_.events, (Events{"scan", "time_jump", "jump", "scan", "scan"}));
  EXPECT_NEAR(diary_.scans[1].pose.T_W_S.translation().x(), 0.02, 1e-6);
  EXPECT_NEAR(diary_.scans[2].pose.T_W_S.translation().x(), 0.04, 1e-6);
}

TEST_F(ScanSynchronizerTest, ALoopingBagStartsAnewWhenPosesJumpBack) {
  addPoses(2.0, 2.5);
  addCloud(2.6);
  addPoses(0.0, 0.5);
  EXPECT_EQ(diary_.events, (Events{"time_jump", "jump"}));
  addCloud(0.2);
  EXPECT_EQ(diary_.events, (Events{"time_jump", "jump", "scan"}));
}

TEST_F(ScanSynchronizerTest, ASingleScanWithAWrongStampIsDroppedAlone) {
  for (const double wrong : {900.0, -900.0}) {
    useConfig(cloudConfig());
    diary_ = Diary();
    addPoses(0.0, 0.5);
    for (const double seconds : {0.1, wrong, 0.2, 0.3}) addCloud(seconds);
    EXPECT_EQ(diary_.events, (Events{"scan", "stale_stamp", "scan", "scan"})) << wrong;
  }
}

TEST_F(ScanSynchronizerTest, AWrongStampCostsNoScanThatWaits) {
  addPose(0.0);
  addCloud(0.02);
  addCloud(900.0);
  addPose(0.03);
  EXPECT_EQ(diary_.events, Events{"scan"});
}

TEST_F(ScanSynchronizerTest, ASinglePoseWithAWrongStampIsRefusedAlone) {
  for (const double wrong : {900.0, -900.0}) {
    useConfig(cloudConfig());
    diary_ = Diary();
    addPoses(0.0, 0.24);
    addPose(wrong);
    addPoses(0.25, 0.5);
    EXPECT_EQ(synchronizer_->poses().refusedPoses(), 1u) << wrong;
    addCloud(0.22);
    EXPECT_EQ(diary_.events, Events{"scan"}) << wrong;
  }
}

TEST_F(ScanSynchronizerTest, TimeGoesOnAfterAPauseOfAllInput) {
  addPoses(0.0, 0.5);
  addCloud(0.1);
  addCloud(60.1);
  addPoses(60.0, 60.5);
  addCloud(60.2);
  EXPECT_EQ(diary_.events, (Events{"scan", "scan", "scan"}));
}

TEST_F(ScanSynchronizerTest, ADoubtfulScanExpires) {
  addPoses(0.0, 0.5);
  addCloud(0.1);
  Moment moment{at(10.0), std::chrono::steady_clock::time_point()};
  addCloud(900.0, moment);
  moment.ros = at(11.0);
  moment.steady += std::chrono::seconds(1);
  synchronizer_->expire(moment);
  EXPECT_EQ(diary_.events, (Events{"scan", "stale_stamp"}));
}

TEST_F(ScanSynchronizerTest, AStepBackOfLessThanASecondIsNoJump) {
  addPoses(0.0, 2.0);
  addCloud(1.1);
  addCloud(0.15);
  addCloud(1.2);
  EXPECT_EQ(diary_.events, (Events{"scan", "stale_stamp", "scan"}));
}

TEST_F(ScanSynchronizerTest, LatePosesAreNoJump) {
  addPose(0.0);
  addPose(1.05);
  addPose(0.1);
  addCloud(0.05);
  EXPECT_EQ(diary_.events, Events{"scan"});
}

TEST_F(ScanSynchronizerTest, ImagesWaitForTheirCameraInfo) {
  addPoses(0.0, 0.5);
  addImage(0.1);
  EXPECT_EQ(synchronizer_->waiting(), 1u);
  addCameraInfo();
  ASSERT_EQ(diary_.events, Events{"scan"});
  EXPECT_DOUBLE_EQ(diary_.scans[0].intrinsics.fx, 4.0);
}

TEST_F(ScanSynchronizerTest, ImagesWithoutCameraInfoAreDropped) {
  addPoses(0.0, 0.5);
  addImage(0.1);
  addImage(0.7);
  EXPECT_EQ(diary_.events, Events{"no_camera_info"});
  addCameraInfo(5);
  EXPECT_EQ(diary_.events, (Events{"no_camera_info", "bad_camera_info"}));
}

TEST_F(ScanSynchronizerTest, WarnsOnceOfABodyFrameUsedAsOpticalFrame) {
  addCameraInfo();
  addPoses(0.0, 1.0);
  for (int i = 1; i <= 9; ++i) addImage(0.1 * i);
  EXPECT_EQ(diary_.scans.size(), 9u);
  ASSERT_EQ(diary_.warnings.size(), 1u);
  EXPECT_NE(diary_.warnings[0].find("camera_link"), std::string::npos);
}

TEST_F(ScanSynchronizerTest, DoesNotWarnOfARotatedCamera) {
  NodeConfig config = cloudConfig();
  config.extrinsic_rotation = {-0.5, 0.5, -0.5, 0.5};
  useConfig(config);
  addCameraInfo();
  addPoses(0.0, 1.0);
  for (int i = 1; i <= 9; ++i) addImage(0.1 * i);
  EXPECT_EQ(diary_.scans.size(), 9u);
  EXPECT_TRUE(diary_.warnings.empty());
}

TEST_F(ScanSynchronizerTest, EveryScanEndsAsExactlyOneEvent) {
  // A mixture of everything: stamps back and forth, poses with gaps and pauses.
  int scans = 0;
  for (int i = 0; i < 2000; ++i) {
    const double now = 0.01 * ((i * 7) % 1600);
    if (i % 3 != 0 && i % 500 < 350) addPose(now + 0.01 * (i % 11));
    addCloud(now - 0.02 * (i % 5));
    ++scans;
  }
  synchronizer_->finish();
  const auto jumps = std::count(diary_.events.begin(), diary_.events.end(), "jump");
  EXPECT_EQ(diary_.events.size(), static_cast<std::size_t>(scans + jumps));
  EXPECT_GT(diary_.scans.size(), 0u);
}

}  // namespace
}  // namespace fiimap
