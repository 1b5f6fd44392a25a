// The examination of a recording must find what is wrong with it.

#include "health/topic_health.h"

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdio>
#include <fstream>

#include "health/health_command.h"
#include "temporary_file.h"

namespace fiimap {
namespace {

constexpr double kTolerance = 1e-6;  // s
constexpr double kStart = 1000.0;    // s

class TopicHealthTest : public testing::Test {
 protected:
  TopicHealthTest() : file_(testing::TempDir() + "topic_health_test.bag") {}
  ~TopicHealthTest() override { std::remove(file_.c_str()); }

  /// \param stamps, delays of each message, s.
  TopicHealth healthWith(const std::vector<double>& stamps, const std::vector<double>& delays) {
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      nav_msgs::Odometry odometry;
      odometry.header.stamp = ros::Time(kStart + stamps[i]);
      bag.write("/odom", ros::Time(kStart + stamps[i] + delays[i]), odometry);
      bag.write("/tf", ros::Time(kStart + stamps[i]), tf2_msgs::TFMessage());
    }
    bag.close();
    bag.open(file_, rosbag::bagmode::Read);
    tf_ = healthOf(bag, "/tf");
    return healthOf(bag, "/odom");
  }

  TopicHealth tf_;

 private:
  std::string file_;
};

TEST_F(TopicHealthTest, TellsRateGapsAndDelay) {
  const TopicHealth health =
      healthWith({0.0, 0.1, 0.2, 0.3, 0.8, 0.9}, {0.01, 0.01, 0.01, 0.05, 0.01, 0.02});
  EXPECT_EQ(health.messages, 6u);
  EXPECT_EQ(health.type, "nav_msgs/Odometry");
  EXPECT_NEAR(health.duration, 0.9, kTolerance);
  EXPECT_NEAR(health.interval.median, 0.1, kTolerance);
  EXPECT_NEAR(health.interval.max, 0.5, kTolerance);
  EXPECT_EQ(health.gaps, 1u);
  EXPECT_EQ(health.backward, 0u);
  EXPECT_NEAR(health.delay.median, 0.01, kTolerance);
  EXPECT_NEAR(health.delay.max, 0.05, kTolerance);
  EXPECT_NEAR(health.least_delay, 0.01, kTolerance);
  EXPECT_NEAR(toJson(health).at("rate_hz"), 5.0 / 0.9, 1e-4);
}

TEST_F(TopicHealthTest, CountsStampsThatGoBack) {
  EXPECT_EQ(healthWith({0.0, 0.1, 0.05, 0.2}, {0.0, 0.0, 0.1, 0.0}).backward, 1u);
}

TEST_F(TopicHealthTest, TakesTimesOfRecordingWhereThereIsNoStamp) {
  healthWith({0.0, 0.1, 0.2}, {0.0, 0.0, 0.0});
  EXPECT_FALSE(tf_.has_stamp);
  EXPECT_NEAR(tf_.interval.median, 0.1, kTolerance);
  EXPECT_FALSE(toJson(tf_).contains("delay_s"));
}

TEST(HealthCommandTest, ExaminesTheSampleRecording) {
  const TemporaryFile json_file("");
  HealthOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/cow_and_lady_excerpt.bag";
  options.input.config = FIIMAP_SOURCE_DIR "/config/cow_and_lady.yaml";
  options.input.json = json_file.path();
  ASSERT_EQ(examineRecording(options), 0);
  nlohmann::json json;
  std::ifstream(json_file.path()) >> json;
  EXPECT_EQ(json.at("integrated"), 4);
  EXPECT_LT(json.at("path_m"), 0.01);  // it stands still
  const nlohmann::json& readings = json.at("readings");
  double sum = 0.0;
  for (const auto& [kind, share] : readings.items()) sum += share.get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NEAR(readings.at("invalid"), 0.65, 0.05);
  const nlohmann::json& clouds = json.at("topics")[0];
  EXPECT_EQ(clouds.at("topic"), "/camera/depth_registered/points");
  EXPECT_EQ(clouds.at("messages"), 4);
  EXPECT_GT(clouds.at("delay_s").at("min"), 0.05);
  EXPECT_EQ(json.at("topics")[1].at("type"), "geometry_msgs/TransformStamped");
}

}  // namespace
}  // namespace fiimap
