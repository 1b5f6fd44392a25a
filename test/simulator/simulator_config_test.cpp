#include "simulator_config.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace fiimap::sim {
namespace {

/// The message of the refusal; empty when the values are accepted.
std::string refusal(const ParameterMap& values) {
  SimulatorConfig config;
  try {
    applyParameters(values, simulatorParameters(&config));
    config.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SimulatorConfigTest, DefaultsAreValidAndNamesAreUnique) {
  EXPECT_EQ(refusal({}), "");
  SimulatorConfig config;
  std::set<std::string> names;
  for (const Parameter& parameter : simulatorParameters(&config)) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
  }
}

TEST(SimulatorConfigTest, RefusesWhatDoesNotFitAndNamesIt) {
  const std::vector<std::pair<ParameterMap, std::string>> cases = {
      {{{"world", "jungle"}}, "world"},
      {{{"seed", "-1"}}, "seed"},
      {{{"world", "mesh"}}, "mesh_file"},
      {{{"min_range", "5"}, {"max_range", "5"}}, "max_range"},
      {{{"max_acceleration", "9.81"}}, "max_acceleration"},
      {{{"lidar_fov_down", "-0.5"}, {"lidar_fov_up", "0.4"}}, "lidar_fov_up"},
      {{{"real_time_factor", "2"}}, "real_time_factor"},
      {{{"real_time_factor", "1e-6"}, {"publish_clock", "true"}}, "real_time_factor"},
      {{{"max_lead", "0.1"}}, "max_lead"},
  };
  for (const auto& [values, name] : cases) {
    EXPECT_NE(refusal(values).find("parameter " + name + " = "), std::string::npos)
        << name << ": " << refusal(values);
  }
}

TEST(SimulatorConfigTest, AcceptsSimulatedTimeAtAnyPace) {
  EXPECT_EQ(refusal({{"publish_clock", "true"}, {"real_time_factor", "0"}, {"max_lead", "0.1"}}),
            "");
}

}  // namespace
}  // namespace fiimap::sim
