#include "fiimap/ros/tuning.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tuning_messages.h"

namespace fiimap {
namespace {

/// A map of several sensors, or of one without a name.
struct Configuration {
  MapperConfig mapper;
  NodeConfig node;

  explicit Configuration(const ParameterMap& values = {}) { configure(values, &mapper, &node); }

  std::vector<Parameter> parameters() { return tunableParameters(&mapper, &node); }
  std::string value(const std::string& name) {
    for (const Parameter& parameter : parameters()) {
      if (parameter.name == name) return parameter.get();
    }
    return "none";
  }
  std::string refusal(const ParameterMap& changes) {
    try {
      tune(changes, &mapper, &node);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
};

std::set<std::string> namesOf(const std::vector<Parameter>& parameters) {
  std::set<std::string> names;
  for (const Parameter& parameter : parameters) names.insert(parameter.name);
  return names;
}

TEST(TuningTest, SetsParametersOfMapAndNode) {
  Configuration configuration;
  EXPECT_EQ(configuration.refusal({{"inflation_radius", "0.4"},
                                   {"max_depth", "5"},
                                   {"time_offset", "-0.02"},
                                   {"publish_rate", "5"}}),
            "");
  EXPECT_EQ(configuration.mapper.inflation_radius, 0.4);
  EXPECT_EQ(configuration.mapper.max_depth, 5.0);
  EXPECT_EQ(configuration.node.time_offset, -0.02);
  EXPECT_EQ(configuration.node.publish_rate, 5.0);
}

TEST(TuningTest, SetsAllOrNone) {
  Configuration configuration;
  EXPECT_EQ(configuration.refusal({{"inflation_radius", "0.4"}, {"p_occ", "0.97"}}),
            "parameter p_occ = 0.970000: must be less than p_max = 0.970000");
  EXPECT_EQ(configuration.refusal({{"inflation_radius", "0.4"}, {"max_pose_wait", "6"}}),
            "parameter pose_history = 5.000000: must be at least max_pose_wait and max_pose_gap");
  EXPECT_EQ(configuration.refusal({{"inflation_radius", "0.4"}, {"publish_rate", "0"}}),
            "parameter publish_rate = '0': must be a number in [0.001, 1000] Hz");
  EXPECT_EQ(configuration.value("inflation_radius"), "0.2");
  // What contradicts the old values may go with each other.
  EXPECT_EQ(configuration.refusal({{"p_occ", "0.97"}, {"p_max", "0.98"}}), "");
}

TEST(TuningTest, SaysWhatCannotChangeAndWhatIsUnknown) {
  Configuration configuration;
  for (const std::string name : {"resolution", "map_frame", "scan_queue_size", "sensor"}) {
    EXPECT_EQ(
        configuration.refusal({{name, "1"}}),
        "parameter " + name + " cannot change while the node runs: set it and start the node anew");
  }
  EXPECT_EQ(configuration.refusal({{"resolutoin", "1"}}), "parameter resolutoin is unknown");
}

TEST(TuningTest, EachOfSeveralSensorsHasItsOwn) {
  Configuration configuration({{"sensors", "front lidar"}, {"lidar/max_depth", "20"}});
  EXPECT_EQ(configuration.refusal({{"front/max_depth", "5"}, {"front/time_offset", "0.1"}}), "");
  EXPECT_EQ(configuration.mapper.sensors[0].max_depth, 5.0);
  EXPECT_EQ(configuration.mapper.sensors[1].max_depth, 20.0);
  EXPECT_EQ(configuration.node.sensors[0].time_offset, 0.1);
  EXPECT_EQ(configuration.refusal({{"lidar/max_ray_length", "0.1"}}),
            "parameter lidar/min_ray_length = 0.300000: must be less than lidar/max_ray_length = "
            "0.100000");
  EXPECT_EQ(configuration.refusal({{"max_depth", "5"}}),
            "parameter max_depth: each sensor has its own: front/max_depth");
  EXPECT_EQ(configuration.refusal({{"front/sensor", "points"}}),
            "parameter front/sensor cannot change while the node runs: set it and start the node "
            "anew");
}

TEST(TuningTest, SensorsTakeTheirParametersFromTheMap) {
  const ParameterMap sensors = {{"sensors", "front lidar"}};
  const std::set<std::string> of_one = namesOf(Configuration().parameters());
  std::set<std::string> of_two = namesOf(Configuration(sensors).parameters());
  for (const std::string& name : of_one) {
    const bool of_map = of_two.erase(name) == 1;
    const bool of_each = of_two.erase("front/" + name) + of_two.erase("lidar/" + name) == 2;
    EXPECT_NE(of_map, of_each) << name;
  }
  EXPECT_TRUE(of_two.empty());
}

// Messages of dynamic_reconfigure.

TEST(TuningMessagesTest, HoldEveryParameterOnceWithItsValue) {
  Configuration configuration({{"inflation_shape", "cube"}, {"round_rays", "false"}});
  configuration.mapper.max_depth = 0.1 + 0.2;  // no short text
  const std::vector<Parameter> parameters = configuration.parameters();
  const ParameterMap values = toParameterMap(toConfig(parameters));
  EXPECT_EQ(values.size(), parameters.size());
  for (const Parameter& parameter : parameters) {
    EXPECT_EQ(values.at(parameter.name), parameter.get());
    EXPECT_EQ(parameter.tunable, true);
  }
  Configuration other;
  EXPECT_EQ(other.refusal(values), "");
  EXPECT_EQ(other.mapper.max_depth, 0.1 + 0.2);
  EXPECT_EQ(other.mapper.inflation_shape, ElementShape::kCube);
}

TEST(TuningMessagesTest, DescribeRangesTypesAndChoices) {
  Configuration configuration;
  const dynamic_reconfigure::ConfigDescription description =
      toDescription(configuration.parameters());
  ASSERT_EQ(description.groups.size(), 1u);
  const ParameterMap min = toParameterMap(description.min), max = toParameterMap(description.max);
  const ParameterMap defaults = toParameterMap(description.dflt);
  for (const auto& entry : description.groups[0].parameters) {
    SCOPED_TRACE(entry.name);
    EXPECT_EQ(defaults.at(entry.name), configuration.value(entry.name));
    const bool is_number = entry.type == "double" || entry.type == "int";
    EXPECT_EQ(is_number, !min.at(entry.name).empty() && entry.type != "bool");
    EXPECT_EQ(entry.type == "str", max.at(entry.name).empty());
    EXPECT_FALSE(entry.description.empty());
    // Texts are chosen from a list, all of them.
    const bool is_chosen = entry.edit_method.find("'enum': [{") != std::string::npos;
    EXPECT_TRUE(entry.type != "str" || is_chosen);
    // What is out of the described range is refused.
    if (!is_number) continue;
    for (const auto& [limit, step] : {std::pair(min, -1.0), std::pair(max, 1.0)}) {
      const std::string beyond = toText(std::stod(limit.at(entry.name)) + step);
      EXPECT_NE(configuration.refusal({{entry.name, beyond}}), "") << beyond;
    }
  }
  const auto& groups = description.groups[0].parameters;
  const auto shape = std::find_if(groups.begin(), groups.end(), [](const auto& entry) {
    return entry.name == "inflation_shape";
  });
  ASSERT_NE(shape, groups.end());
  EXPECT_EQ(shape->edit_method,
            "{'enum_description': 'ball, cube or diamond', 'enum': [{'name': 'ball', 'type': "
            "'str', 'value': 'ball', 'description': ''}, {'name': 'cube', 'type': 'str', 'value': "
            "'cube', 'description': ''}, {'name': 'diamond', 'type': 'str', 'value': 'diamond', "
            "'description': ''}]}");
}

}  // namespace
}  // namespace fiimap
