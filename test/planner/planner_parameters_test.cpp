#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "fiimap/ros/parameter_sources.h"
#include "planner_config.h"

namespace fiimap {
namespace {

std::string textOf(const std::string& file) {
  std::ifstream stream(std::string(FIIMAP_SOURCE_DIR) + "/" + file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(PlannerParametersTest, TheConfigurationFileHoldsAllDefaults) {
  const ParameterMap file =
      parameterMapFromYaml(std::string(FIIMAP_SOURCE_DIR) + "/config/planner.yaml");
  PlannerParameters defaults, loaded;
  EXPECT_TRUE(configure(file, &loaded).empty()) << "a name that is no parameter";
  const std::vector<Parameter> expected = plannerParameters(&defaults),
                               actual = plannerParameters(&loaded);
  EXPECT_EQ(file.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(file.count(expected[i].name), 1u) << expected[i].name;
    EXPECT_EQ(actual[i].get(), expected[i].get()) << expected[i].name;
  }
}

TEST(PlannerParametersTest, RangesAndUnitsAreInTheConfigurationFile) {
  const std::string text = textOf("config/planner.yaml");
  PlannerParameters defaults;
  for (const Parameter& parameter : plannerParameters(&defaults)) {
    const std::size_t at = text.find("\n" + parameter.name + ":");
    ASSERT_NE(at, std::string::npos) << parameter.name;
    const std::string comment = std::regex_replace(
        text.substr(text.rfind("\n\n", at), at - text.rfind("\n\n", at)), std::regex("\n# "), " ");
    std::smatch range;
    if (!std::regex_search(parameter.allowed, range, std::regex("\\[.*"))) continue;
    EXPECT_NE(comment.find(range.str()), std::string::npos)
        << parameter.name << ": " << range.str();
  }
}

TEST(PlannerParametersTest, EveryParameterIsDocumented) {
  const std::string text = textOf("docs/planner.md");
  PlannerParameters defaults;
  for (const Parameter& parameter : plannerParameters(&defaults)) {
    EXPECT_NE(text.find("`" + parameter.name + "`"), std::string::npos) << parameter.name;
  }
}

std::string refusal(const std::string& name, const std::string& value) {
  PlannerParameters parameters;
  try {
    configure({{name, value}}, &parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PlannerParametersTest, RefusalsNameParameterValueAndRange) {
  EXPECT_EQ(refusal("max_speed", "0"),
            "parameter max_speed = '0': must be a number in [0.05, 50] m/s");
  EXPECT_EQ(refusal("unknown", "maybe"), "parameter unknown = 'maybe': must be obstacle or free");
  EXPECT_EQ(refusal("map", ""), "parameter map = '': must be the name of the mapping nodelet");
  for (const std::string bad : {"1 2", "1 2 x", "1 2 nan", "1 2 1e9", "[1, 2, 3, 4]"}) {
    EXPECT_NE(refusal("waypoints", bad).find("parameter waypoints = '" + bad + "': must be"),
              std::string::npos)
        << bad;
  }
}

TEST(PlannerParametersTest, WaypointsAreTriplesOfNumbers) {
  PlannerParameters parameters;
  configure({{"waypoints", "[1, 2, 3, 4, 5, 6]"}}, &parameters);
  ASSERT_EQ(parameters.node.waypoints.size(), 2u);
  EXPECT_EQ(parameters.node.waypoints[1], Eigen::Vector3d(4, 5, 6));
  configure({{"waypoints", ""}}, &parameters);
  EXPECT_TRUE(parameters.node.waypoints.empty());
}

TEST(PlannerParametersTest, UnknownNamesAreReturned) {
  PlannerParameters parameters;
  EXPECT_EQ(configure({{"max_sped", "1"}}, &parameters), std::vector<std::string>{"max_sped"});
}

}  // namespace
}  // namespace fiimap
