// What goes over a link, of the sample recording.

#include "bandwidth_command.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "json_file.h"
#include "temporary_file.h"

namespace fiimap {
namespace {

constexpr int kScans = 110;  // at 10 Hz

nlohmann::json bandwidthWith(const std::vector<std::string>& settings) {
  const TemporaryFile json_file("");
  BandwidthOptions options;
  options.input.bag = FIIMAP_SOURCE_DIR "/data/synth_flight_excerpt.bag";
  options.input.settings = settings;
  options.input.json = json_file.path();
  EXPECT_EQ(measureBandwidth(options), 0);
  return readJson(json_file.path());
}

TEST(BandwidthTest, ChangesAreAThousandthOfTheCloudsAndMakeTheSame) {
  const nlohmann::json json = bandwidthWith({"keyframe_period=1"});
  EXPECT_EQ(json.at("integrated"), kScans);
  EXPECT_NEAR(json.at("seconds"), 10.9, 0.1);
  EXPECT_EQ(json.at("wrong"), 0);
  for (const char* topic : {"occupied", "inflated", "changes"}) {
    EXPECT_EQ(json.at(topic).at("messages"), kScans) << topic;
  }
  EXPECT_EQ(json.at("keyframes").at("messages"), 11);
  const double clouds =
      json.at("occupied").at("bytes").get<double>() + json.at("inflated").at("bytes").get<double>();
  const double changes = json.at("changes").at("bytes");
  EXPECT_LT(changes, clouds / 1000.0);
  EXPECT_GT(changes, json.at("keyframes").at("bytes"));
}

TEST(BandwidthTest, PublishesAtMostAtItsRate) {
  const nlohmann::json json = bandwidthWith({"publish_rate=1", "keyframe_period=3"});
  EXPECT_EQ(json.at("changes").at("messages"), 12);  // at the first scan and 11 s on
  EXPECT_EQ(json.at("keyframes").at("messages"), 4);
  EXPECT_EQ(json.at("wrong"), 0);
}

}  // namespace
}  // namespace fiimap
