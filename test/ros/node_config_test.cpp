#include "fiimap/ros/node_config.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fiimap/ros/parameter_sources.h"

namespace fiimap {
namespace {

void expectRefused(const ParameterMap& values, const std::string& part) {
  MapperConfig mapper;
  NodeConfig node;
  try {
    configure(values, &mapper, &node);
    ADD_FAILURE() << "accepted, expected: " << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(NodeConfigTest, TheDefaultsAreValid) {
  MapperConfig mapper;
  NodeConfig node;
  EXPECT_TRUE(configure({}, &mapper, &node).empty());
}

TEST(NodeConfigTest, SetsParametersOfMapAndNodeAndReturnsUnknownNames) {
  MapperConfig mapper;
  NodeConfig node;
  const std::vector<std::string> unknown = configure({{"resolution", "0.25"},
                                                      {"map_frame", "odom"},
                                                      {"pose_source", "transform"},
                                                      {"extrinsic_translation", "[1, -2.5, 3e-1]"},
                                                      {"extrinsic_rotation", "0 0 1 0"},
                                                      {"resolutoin", "1"}},
                                                     &mapper, &node);
  EXPECT_EQ(unknown, std::vector<std::string>{"resolutoin"});
  EXPECT_DOUBLE_EQ(mapper.resolution, 0.25);
  EXPECT_EQ(node.map_frame, "odom");
  EXPECT_EQ(node.pose_source, PoseSource::kTransform);
  EXPECT_EQ(node.extrinsic_translation, Eigen::Vector3d(1.0, -2.5, 0.3));
  const Eigen::Vector3d point_B = node.parameterExtrinsics() * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_TRUE(point_B.isApprox(Eigen::Vector3d(0.0, -2.5, 0.3)));
}

TEST(NodeConfigTest, RefusesWhatMakesNoSense) {
  expectRefused({{"sensor", "lidar"}}, "depth or points");
  expectRefused({{"map_frame", ""}}, "map_frame");
  expectRefused({{"map_frame", "/world"}}, "'/'");
  expectRefused({{"max_pose_gap", "0"}}, "max_pose_gap");
  expectRefused({{"scan_queue_size", "0"}}, "scan_queue_size");
  expectRefused({{"pose_history", "0.2"}}, "pose_history");
  expectRefused({{"extrinsic_translation", "1 2"}}, "3 finite numbers");
  expectRefused({{"extrinsic_translation", "1 2 3 4"}}, "3 finite numbers");
  expectRefused({{"extrinsic_translation", "1 2 nan"}}, "3 finite numbers");
  expectRefused({{"extrinsic_rotation", "0 0 0 0"}}, "norm 1");
  expectRefused({{"pose_source", "pose"}}, "body_frame");
  expectRefused({{"pose_source", "tf"}, {"extrinsics", "parameter"}}, "body_frame");
}

TEST(NodeConfigTest, EveryParameterReadsBackWhatItWrites) {
  NodeConfig config;
  config.extrinsic_translation = {0.1, -1e-5, 12345.678};
  NodeConfig copy;
  std::vector<Parameter> from = nodeParameters(&config);
  std::vector<Parameter> to = nodeParameters(&copy);
  for (std::size_t i = 0; i < from.size(); ++i) to[i].set(from[i].get());
  EXPECT_EQ(copy.extrinsic_translation, config.extrinsic_translation);
  for (std::size_t i = 0; i < from.size(); ++i) EXPECT_EQ(to[i].get(), from[i].get());
}

TEST(SensorsTest, ASensorHasWhatIsSetForAllUnlessItIsSetForIt) {
  MapperConfig mapper;
  NodeConfig node;
  EXPECT_TRUE(configure({{"sensors", "[front, lidar]"},
                         {"extrinsics", "parameter"},
                         {"max_depth", "5"},
                         {"pixel_step", "3"},
                         {"front/max_depth", "4"},
                         {"front/extrinsic_translation", "1 2 3"},
                         {"lidar/sensor", "points"},
                         {"lidar/max_ray_length", "30"},
                         {"lidar/time_offset", "-0.1"}},
                        &mapper, &node)
                  .empty());
  ASSERT_EQ(node.sensors.size(), 2u);
  ASSERT_EQ(mapper.sensors.size(), 2u);
  const SensorConfig &front = node.sensors[0], &lidar = node.sensors[1];
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(lidar.name, "lidar");
  EXPECT_EQ(front.sensor, SensorKind::kDepth);
  EXPECT_EQ(lidar.sensor, SensorKind::kPoints);
  for (const SensorConfig& sensor : node.sensors) {
    EXPECT_EQ(sensor.extrinsics, ExtrinsicsSource::kParameter);
  }
  EXPECT_EQ(front.extrinsic_translation, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(lidar.extrinsic_translation, Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(lidar.time_offset, -0.1);
  EXPECT_DOUBLE_EQ(mapper.readingOf(0).max_depth, 4.0);
  EXPECT_DOUBLE_EQ(mapper.readingOf(1).max_depth, 5.0);
  EXPECT_DOUBLE_EQ(mapper.readingOf(0).max_ray_length, ReadingConfig().max_ray_length);
  EXPECT_DOUBLE_EQ(mapper.readingOf(1).max_ray_length, 30.0);
  for (const ReadingConfig& reading : mapper.sensors) EXPECT_EQ(reading.pixel_step, 3);
}

TEST(SensorsTest, WithoutNamesThereIsOneAsEver) {
  MapperConfig mapper;
  NodeConfig node;
  EXPECT_TRUE(configure({{"sensors", ""}, {"sensor", "points"}, {"max_depth", "5"}}, &mapper, &node)
                  .empty());
  ASSERT_EQ(node.allSensors().size(), 1u);
  EXPECT_EQ(node.allSensors()[0].name, "");
  EXPECT_EQ(node.allSensors()[0].sensor, SensorKind::kPoints);
  EXPECT_EQ(mapper.sensorCount(), 1u);
  EXPECT_DOUBLE_EQ(mapper.readingOf(0).max_depth, 5.0);
}

TEST(SensorsTest, EveryParameterOfASensorReadsBackUnderItsName) {
  MapperConfig mapper;
  NodeConfig node;
  configure({{"sensors", "a b"}}, &mapper, &node);
  const std::vector<Parameter> parameters = sensorParameters(&mapper, &node);
  EXPECT_EQ(parameters.size(), 30u);
  ParameterMap values = {{"sensors", "a b"}};
  for (const Parameter& parameter : parameters) values[parameter.name] = parameter.get();
  EXPECT_EQ(values.size(), parameters.size() + 1);
  EXPECT_TRUE(configure(values, &mapper, &node).empty());
}

TEST(SensorsTest, NamesAreRefusedThatAreNone) {
  for (const std::string name :
       {"1st", "front-left", "front/left", "_front", "~front", "fr\xC3\xB6"}) {
    expectRefused({{"sensors", "front " + name}}, "'" + name + "' is no name");
  }
  expectRefused({{"sensors", "front left front"}}, "'front' stands there twice");
  expectRefused({{"sensors", "front max_depth"}}, "'max_depth' is the name of a parameter");
  std::string many;
  for (std::size_t i = 0; i <= NodeConfig::kMaxSensors; ++i) many += " s" + std::to_string(i);
  expectRefused({{"sensors", many}}, "at most 32");
}

TEST(SensorsTest, AValueThatIsNotAllowedIsNamedWithItsSensor) {
  expectRefused({{"sensors", "front"}, {"front/max_depth", "x"}},
                "front/max_depth = 'x': must be a number in [0, 1000] m");
  expectRefused({{"sensors", "front"}, {"front/sensor", "sonar"}}, "front/sensor = 'sonar'");
  expectRefused({{"sensors", "front"}, {"front/min_depth", "5"}, {"front/max_depth", "4"}},
                "front/min_depth = 5.000000: must be less than front/max_depth");
  expectRefused({{"sensors", "front"}, {"front/extrinsic_rotation", "0 0 0 2"}},
                "front/extrinsic_rotation = '0 0 0 2'");
  expectRefused({{"sensors", "front"}, {"pose_source", "tf"}, {"front/extrinsics", "parameter"}},
                "body_frame = '': must be set, because front/extrinsics");
}

TEST(SensorsTest, SeveralOnTfNeedTheFrameOfTheVehicle) {
  MapperConfig mapper;
  NodeConfig node;
  EXPECT_TRUE(configure({{"sensors", "front"}, {"pose_source", "tf"}}, &mapper, &node).empty());
  ParameterMap several = {{"sensors", "front lidar"}, {"pose_source", "tf"}};
  expectRefused(several, "body_frame = '': must be set, because with several sensors pose_source");
  several["body_frame"] = "base_link";
  EXPECT_TRUE(configure(several, &mapper, &node).empty());
}

TEST(SensorsTest, NamesThatNoSensorHasAreReturned) {
  MapperConfig mapper;
  NodeConfig node;
  const std::vector<std::string> unknown = configure({{"sensors", "front"},
                                                      {"front/max_dpeth", "1"},
                                                      {"front/resolution", "1"},
                                                      {"front/sensor", "points"},
                                                      {"rear/max_depth", "1"},
                                                      {"rear/min_depth", "1"}},
                                                     &mapper, &node);
  EXPECT_EQ(unknown, (std::vector<std::string>{"front/max_dpeth", "front/resolution", "rear"}));
  EXPECT_NE(hintForUnknown("front/max_dpeth").find("max_depth"), std::string::npos);
  EXPECT_EQ(hintForUnknown("rear"), "");
}

class YamlTest : public testing::Test {
 protected:
  ~YamlTest() override { std::remove(file_.c_str()); }
  ParameterMap read(const std::string& text) const {
    std::ofstream(file_) << text;
    return parameterMapFromYaml(file_);
  }

  std::string file_ = testing::TempDir() + "fiimap_node_config_test.yaml";
};

TEST_F(YamlTest, ReadsScalarsAndListsAsText) {
  const ParameterMap values = read(
      "# comment\n"
      "resolution: 1e-1\n"
      "virtual_walls: True\n"
      "map_frame: \"on\"\n"
      "body_frame: \"\"\n"
      "extrinsic_translation: [1, -2.5, 0.0]\n");
  EXPECT_EQ(values, (ParameterMap{{"resolution", "1e-1"},
                                  {"virtual_walls", "true"},
                                  {"map_frame", "on"},
                                  {"body_frame", ""},
                                  {"extrinsic_translation", "1 -2.5 0.0"}}));
}

TEST_F(YamlTest, NamesOfNestedMapsComeOutAsUnknown) {
  MapperConfig mapper;
  NodeConfig node;
  const ParameterMap values = read("mapper:\n  resolution: 0.2\n");
  EXPECT_EQ(configure(values, &mapper, &node), std::vector<std::string>{"mapper"});
}

TEST_F(YamlTest, ReadsSensorsWithTheirNames) {
  const ParameterMap values = read(
      "sensors: [front, lidar]\n"
      "front: {max_depth: 4.0, extrinsic_translation: [1, 2, 3], odd: {a: 1}}\n"
      "lidar/sensor: points\n");
  EXPECT_EQ(values, (ParameterMap{{"sensors", "front lidar"},
                                  {"front/max_depth", "4.0"},
                                  {"front/extrinsic_translation", "1 2 3"},
                                  {"front/odd", "{a: 1}"},
                                  {"lidar/sensor", "points"}}));
}

TEST_F(YamlTest, AValueOfASensorThatIsNoneIsNamedWithWhatItIs) {
  const std::string front = "sensors: [front]\nfront: ";
  expectRefused(read(front + "{max_depth: {a: 1}}\n"), "front/max_depth = '{a: 1}': must be");
  expectRefused(read(front + "{extrinsic_translation: [1, 2, x y]}\n"),
                "front/extrinsic_translation = '[1, 2, x y]': must be");
}

TEST_F(YamlTest, RefusesWhatIsNoMapOfValues) {
  EXPECT_TRUE(read("").empty());
  for (const std::string name : {"''", "'front left'"}) {
    EXPECT_THROW(read("sensors: [lidar, " + name + "]\n"), std::invalid_argument) << name;
  }
  EXPECT_THROW(read("- 1\n- 2\n"), std::invalid_argument);
  EXPECT_THROW(read("a: [1, 2\n"), std::invalid_argument);
  EXPECT_THROW(parameterMapFromYaml("/nonexistent.yaml"), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
