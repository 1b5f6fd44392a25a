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

TEST_F(YamlTest, RefusesWhatIsNoFlatMap) {
  EXPECT_TRUE(read("").empty());
  EXPECT_THROW(read("- 1\n- 2\n"), std::invalid_argument);
  EXPECT_THROW(read("a: [1, 2\n"), std::invalid_argument);
  EXPECT_THROW(parameterMapFromYaml("/nonexistent.yaml"), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
