// The offline tool must notice what it is there to notice.

#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "bag_topics.h"
#include "fiimap/snapshot.h"
#include "inflation_check.h"
#include "run_report.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

constexpr double kResolution = 0.1;

class InflationCheckTest : public testing::Test {
 protected:
  InflationCheckTest() : grid_({20, 20, 20}) {
    grid_.moveTo(VoxelIndex::Zero(), &changes_);
    grid_.set(Plane::kOccupied, {10, 10, 10}, true);
    grid_.set(Plane::kOccupied, {0, 10, 19}, true);  // at two faces: inflation is cut off there
    for (const VoxelIndex& obstacle : {VoxelIndex(10, 10, 10), VoxelIndex(0, 10, 19)}) {
      grid_.set(Plane::kInflated, obstacle, true);
      for (int axis = 0; axis < 3; ++axis) {
        grid_.set(Plane::kInflated, obstacle + VoxelIndex::Unit(axis), true);
        grid_.set(Plane::kInflated, obstacle - VoxelIndex::Unit(axis), true);
      }
    }
  }

  std::int64_t mismatches() {
    Snapshot::Info info;
    info.resolution = kResolution;
    info.inflation_radius = kResolution;
    return countInflationMismatches(Snapshot(&grid_, info));
  }

  ChangeSet changes_;
  SlidingGrid grid_;
};

TEST_F(InflationCheckTest, FindsNothingInAnExactMap) { EXPECT_EQ(mismatches(), 0); }

TEST_F(InflationCheckTest, CountsMissingVoxels) {
  grid_.set(Plane::kInflated, {10, 10, 11}, false);
  grid_.set(Plane::kInflated, {1, 10, 19}, false);
  EXPECT_EQ(mismatches(), 2);
}

TEST_F(InflationCheckTest, CountsSpuriousVoxels) {
  grid_.set(Plane::kInflated, {10, 10, 12}, true);
  grid_.set(Plane::kInflated, {19, 0, 0}, true);  // far from every obstacle
  EXPECT_EQ(mismatches(), 2);
}

TEST_F(InflationCheckTest, CountsBothKindsTogether) {
  grid_.set(Plane::kInflated, {10, 10, 11}, false);
  grid_.set(Plane::kInflated, {10, 10, 12}, true);
  EXPECT_EQ(mismatches(), 2);
}

TEST_F(InflationCheckTest, CountsEverythingWhereNothingIsOccupied) {
  grid_.clear();
  grid_.set(Plane::kInflated, {3, 4, 5}, true);
  EXPECT_EQ(mismatches(), 1);
}

/// A bag of images, each on a topic of its own with an encoding, and of what belongs to them.
class BagTopicsTest : public testing::Test {
 protected:
  BagTopicsTest() : file_(testing::TempDir() + "bag_topics_test.bag") {}
  ~BagTopicsTest() override { std::remove(file_.c_str()); }

  std::string chosen(const std::map<std::string, std::string>& encodings) {
    const ros::Time stamp(1.0);
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    for (const auto& [topic, encoding] : encodings) {
      sensor_msgs::Image image;
      image.encoding = encoding;
      bag.write(topic, stamp, image);
    }
    bag.write("/info", stamp, sensor_msgs::CameraInfo());
    bag.write("/odom", stamp, nav_msgs::Odometry());
    bag.close();
    bag.open(file_, rosbag::bagmode::Read);
    NodeConfig config;
    return chooseTopics(bag, {}, BagTopics(), &config).sensors.front().depth_topic;
  }

 private:
  std::string file_;
};

TEST_F(BagTopicsTest, TellsDepthImagesFromColourImages) {
  for (const std::string depth : {"16UC1", "mono16", "32FC1"}) {
    EXPECT_EQ(chosen({{"/color", "rgb8"}, {"/depth", depth}, {"/left", "mono8"}}), "/depth");
  }
}

TEST_F(BagTopicsTest, SaysWhatItFoundInsteadOfDepthImages) {
  try {
    chosen({{"/color", "rgb8"}});
    ADD_FAILURE() << "a colour image was taken for a depth image";
  } catch (const std::invalid_argument& error) {
    for (const std::string part : {"no depth images", "/color", "rgb8"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

class SensorTopicsTest : public testing::Test {
 protected:
  SensorTopicsTest() : file_(testing::TempDir() + "sensor_topics_test.bag") {
    config_.sensors.resize(2);
    config_.sensors[0].name = "front";
    config_.sensors[1].name = "left";
  }
  ~SensorTopicsTest() override { std::remove(file_.c_str()); }

  BagTopics chosen(const std::vector<std::string>& images, const std::vector<std::string>& infos,
                   const ParameterMap& named = {}) {
    const ros::Time stamp(1.0);
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    sensor_msgs::Image image;
    image.encoding = "16UC1";
    for (const std::string& topic : images) bag.write(topic, stamp, image);
    for (const std::string& topic : infos) bag.write(topic, stamp, sensor_msgs::CameraInfo());
    bag.write("/odom", stamp, nav_msgs::Odometry());
    bag.close();
    bag.open(file_, rosbag::bagmode::Read);
    BagTopics topics;
    EXPECT_TRUE(applyParameters(named, topics.parameters(config_)).empty());
    return chooseTopics(bag, {}, topics, &config_);
  }

  NodeConfig config_;

 private:
  std::string file_;
};

TEST_F(SensorTopicsTest, AreThoseOfTheNode) {
  const BagTopics topics = chosen({"/front/depth/image", "/left/depth/image", "/rear/depth/image"},
                                  {"/front/depth/camera_info", "/left/depth/camera_info"});
  EXPECT_EQ(topics.sensors[0].depth_topic, "/front/depth/image");
  EXPECT_EQ(topics.sensors[1].depth_topic, "/left/depth/image");
  EXPECT_EQ(topics.sensors[0].camera_info_topic, "/front/depth/camera_info");
  EXPECT_EQ(topics.sensors[1].camera_info_topic, "/left/depth/camera_info");
}

TEST_F(SensorTopicsTest, OrThoseThatAreNamedForEach) {
  const BagTopics topics =
      chosen({"/a", "/b"}, {"/info"}, {{"front/depth_topic", "/b"}, {"left/depth_topic", "/a"}});
  EXPECT_EQ(topics.sensors[0].depth_topic, "/b");
  EXPECT_EQ(topics.sensors[1].depth_topic, "/a");
  for (const auto& sensor : topics.sensors) EXPECT_EQ(sensor.camera_info_topic, "/info");
}

TEST_F(SensorTopicsTest, OneTopicIsNotReadTwice) {
  for (const auto& images : {std::vector<std::string>{"/a"}, {"/a", "/b"}}) {
    try {
      chosen(images, {"/info"});
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("/depth_topic=TOPIC"), std::string::npos)
          << error.what();
    }
  }
}

TEST_F(SensorTopicsTest, AreOfTheTypeThatTheyShouldBe) {
  const std::vector<std::string> images = {"/front/depth/image", "/left/depth/image"};
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"front/camera_info_topic", "/left/depth/image"},
      {"left/depth_topic", "/info"},
      {"pose_topic", "/info"}};
  for (const auto& [parameter, topic] : wrong) {
    try {
      chosen(images, {"/info"}, {{parameter, topic}});
      ADD_FAILURE() << parameter << " = " << topic << " was accepted";
    } catch (const std::invalid_argument& error) {
      const std::string type = topic == "/info" ? "sensor_msgs/CameraInfo" : "sensor_msgs/Image";
      const std::string expected =
          "parameter " + parameter + " = '" + topic + "': is of type " + type;
      EXPECT_EQ(std::string(error.what()).find(expected), 0u) << error.what();
    }
  }
  const ParameterMap right = {{"front/camera_info_topic", "/info"}, {"pose_topic", "/odom"}};
  EXPECT_NO_THROW(chosen(images, {"/info"}, right));
}

class IdleEvaluator : public ScanEvaluator {
  void addScan(const SynchronizedScan& /*scan*/, std::size_t /*index*/) override {}
  void forget() override {}
};

TEST(ScanEvaluatorTest, EveryWarningOfASensorIsKept) {
  const std::string file = testing::TempDir() + "scan_evaluator_test.bag";
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  sensor_msgs::CameraInfo info;
  info.D = {0.5, 0.1, 0.0, 0.0, 0.0};
  info.width = info.height = 2;
  info.K = {2.0, 0.0, 1.0, 0.0, 2.0, 1.0, 0.0, 0.0, 1.0};
  for (int i = 1; i <= 9; ++i) {
    const ros::Time stamp(10.0 + 0.05 * i);
    sensor_msgs::Image image;  // upwards: the frame of a body
    image.encoding = "16UC1";
    image.width = image.height = 2;
    nav_msgs::Odometry odometry;
    odometry.header.frame_id = "world";
    odometry.pose.pose.orientation.w = 1.0;
    info.header.stamp = image.header.stamp = odometry.header.stamp = stamp;
    bag.write("/odom", stamp, odometry);
    bag.write("/front/depth/camera_info", stamp, info);
    bag.write("/front/depth/image", stamp, image);
  }
  bag.close();
  InputOptions options;
  options.bag = file;
  options.settings = {"sensors=front", "extrinsics=parameter"};
  IdleEvaluator evaluator;
  evaluator.play(EvaluationInput(options));
  EXPECT_EQ(evaluator.warnings().size(), 2u);
  for (const std::string& warning : evaluator.warnings()) {
    EXPECT_EQ(warning.find("front: "), 0u) << warning;
  }
  std::remove(file.c_str());
}

TEST(RunReportTest, HasTheDocumentedKeysAndFigures) {
  RunReport report;
  for (const double milliseconds : {1.0, 2.0, 3.0, 4.0}) {
    ScanReport scan;
    scan.times_ms.raycast = milliseconds;
    scan.raise = 1;
    scan.lower = 2;
    report.add(scan);
  }
  report.addVerification(0);
  report.addVerification(3);
  ScanCounters counters;
  counters.received = 5;
  counters.integrated = 4;
  counters.countDrop({DropReason::kPoseGap, "a gap"});
  SlidingGrid grid({10, 10, 10});
  grid.set(Plane::kOccupied, VoxelIndex::Zero(), true);
  Snapshot::Info info;
  info.resolution = kResolution;
  report.finish(counters, Snapshot(&grid, info), 2000);

  const nlohmann::json json = report.json();
  EXPECT_EQ(json.at("scans"), 5);
  EXPECT_EQ(json.at("integrated"), 4);
  EXPECT_EQ(json.at("dropped"), nlohmann::json({{"pose_gap", 1}}));
  EXPECT_EQ(json.at("total_ms"), nlohmann::json({{"median", 2.0}, {"p95", 4.0}, {"max", 4.0}}));
  EXPECT_EQ(json.at("stages_ms").at("raycast").at("max"), 4.0);
  for (const char* stage : {"project", "slide", "raycast", "fuse", "inflate", "snapshot"}) {
    for (const char* quantile : {"median", "p95", "max"}) {
      EXPECT_TRUE(json.at("stages_ms").at(stage).contains(quantile)) << stage << ' ' << quantile;
    }
  }
  EXPECT_EQ(json.at("change_score").at("median"), 3.0);
  EXPECT_EQ(json.at("occupied"), 1);
  EXPECT_EQ(json.at("inflated"), 0);
  EXPECT_EQ(json.at("memory_bytes"), 2000);
  EXPECT_EQ(json.at("bytes_per_voxel"), 2.0);
  EXPECT_EQ(json.at("verified"), 2);
  EXPECT_EQ(json.at("mismatches"), 3);
}

}  // namespace
}  // namespace fiimap
