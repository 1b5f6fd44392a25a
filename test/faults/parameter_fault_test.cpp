// Every fault of faults.yaml that is a parameter, as the nodelet and the offline tool read them.

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fault_catalogue.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/tuning.h"

namespace fiimap {
namespace {

/// Values for one parameter or several that go together; the first one is at fault.
using Setting = std::vector<std::pair<std::string, std::string>>;
using Settings = std::vector<Setting>;

struct Range {
  double min = 0.0, max = 0.0;
};

std::vector<Parameter> allParameters() {
  static MapperConfig mapper;
  static NodeConfig node;
  std::vector<Parameter> parameters = mapperParameters(&mapper);
  for (Parameter& parameter : nodeParameters(&node)) parameters.push_back(std::move(parameter));
  return parameters;
}

/// "a number in [0.01, 10] m", for instance; false for what has no range.
bool parseRange(const std::string& allowed, Range* range) {
  const std::size_t begin = allowed.find('[');
  if (begin == std::string::npos) return false;
  char comma = 0;
  std::istringstream(allowed.substr(begin + 1)) >> range->min >> comma >> range->max;
  return comma == ',';
}

std::string text(double value) {
  std::ostringstream stream;
  stream.precision(17);
  stream << value;
  return stream.str();
}

/// One setting for each parameter whose description of the allowed values holds `kind`.
Settings forAll(const std::string& kind, const std::vector<std::string>& values) {
  Settings settings;
  for (const Parameter& parameter : allParameters()) {
    if (parameter.allowed.find(kind) == std::string::npos) continue;
    for (const std::string& value : values) settings.push_back({{parameter.name, value}});
  }
  return settings;
}

Settings forAllRanges(const std::function<std::vector<double>(const Range&)>& values) {
  Settings settings;
  for (const Parameter& parameter : allParameters()) {
    Range range;
    if (!parseRange(parameter.allowed, &range)) continue;
    for (const double value : values(range)) settings.push_back({{parameter.name, text(value)}});
  }
  return settings;
}

Settings noNumbers() {
  const std::vector<std::string> values = {"coarse",  "",   "nan",  "inf", "-inf", "1e999",
                                           "0.5 0.5", "1x", "0x10", "0,5", "true"};
  return forAll(" in [", values);
}

Settings noChoices() {
  Settings settings;
  for (const std::string name :
       {"map_mode", "invalid_depth", "infinite_depth", "beyond_max_depth", "inflation_shape",
        "inflation_method", "bfs_connectivity", "sensor", "pose_source", "extrinsics"}) {
    for (const std::string value : {"", "sonar", "Depth", "0"}) settings.push_back({{name, value}});
  }
  return settings;
}

Settings wrongOrders() {
  return {
      {{"min_depth", "3"}, {"max_depth", "3"}},
      {{"min_ray_length", "4"}, {"max_ray_length", "3"}},
      {{"p_occ", "0.9"}, {"p_max", "0.9"}},
      {{"p_min", "0.4"}, {"p_miss", "0.3"}},
      {{"virtual_floor", "1"}, {"virtual_ceiling", "0"}, {"virtual_walls", "true"}},
  };
}

Settings sensorNames() {
  Settings settings;
  for (const std::string value :
       {"1st", "front-left", "front /left", "a ~b", "a b a", "front max_depth", "sensors"}) {
    settings.push_back({{"sensors", value}});
  }
  return settings;
}

Settings valuesOfASensor() {
  Settings settings = {
      {{"front/max_depth", "x"}},
      {{"front/max_depth", ""}},
      {{"front/max_depth", "1001"}},
      {{"front/sensor", "sonar"}},
      {{"front/pixel_step", "-1"}},
      {{"front/extrinsic_rotation", "0 0 0 2"}},
      {{"front/extrinsic_translation", "1 2"}},
      {{"front/min_depth", "4"}, {"front/max_depth", "4"}},
      {{"front/min_ray_length", "4"}, {"max_ray_length", "3"}},
  };
  for (Setting& setting : settings) setting.push_back({"sensors", "front"});
  return settings;
}

// Tuning: what may change while the node runs, and what may not.

Settings onlyTunable(const Settings& settings, bool tunable = true) {
  Settings kept;
  for (const Parameter& parameter : allParameters()) {
    if (parameter.tunable != tunable) continue;
    std::copy_if(settings.begin(), settings.end(), std::back_inserter(kept),
                 [&](const Setting& setting) { return setting.front().first == parameter.name; });
  }
  return kept;
}

Settings oneForEach(const std::string& value) {
  Settings settings;
  for (const Parameter& parameter : allParameters()) settings.push_back({{parameter.name, value}});
  return settings;
}

Settings outOfRange() {
  return onlyTunable(forAllRanges([](const Range& r) {
    return std::vector<double>{r.min - 1e-6 * std::max(1.0, std::abs(r.min)),
                               r.max + 1e-6 * std::max(1.0, std::abs(r.max)), 1e300};
  }));
}

Settings noNumbersToTune() {
  Settings settings = onlyTunable(noNumbers());
  for (const Setting& fraction : onlyTunable(forAll("a whole number", {"1.5"}))) {
    settings.push_back(fraction);
  }
  return settings;
}

Settings noChoicesToTune() {
  Settings settings = onlyTunable(noChoices());
  for (const Setting& flag : onlyTunable(forAll("true or false", {"perhaps", ""}))) {
    settings.push_back(flag);
  }
  return settings;
}

/// Of a map of several sensors.
Settings ofAllSensors() {
  Settings settings;
  for (const std::string name : {"max_depth", "pixel_step", "max_ray_length", "time_offset"}) {
    settings.push_back({{name, "1"}});
  }
  return settings;
}

/// Settings by the id of their row. All of a row must be refused, but for those named as accepted.
const std::map<std::string, Settings>& settings() {
  static const std::map<std::string, Settings> all = {
      {"parameter_below", forAllRanges([](const Range& r) {
         return std::vector<double>{r.min - 1e-6 * std::max(1.0, std::abs(r.min)), -1e300};
       })},
      {"parameter_above", forAllRanges([](const Range& r) {
         return std::vector<double>{r.max + 1e-6 * std::max(1.0, std::abs(r.max)), 1e300};
       })},
      {"parameter_at_its_limits", forAllRanges([](const Range& r) {
         return std::vector<double>{r.min, r.max};
       })},
      {"parameter_no_number", noNumbers()},
      {"parameter_fraction", forAll("a whole number", {"1.5", "1.0000001", "1e-9"})},
      {"parameter_choice", noChoices()},
      {"parameter_flag", forAll("true or false", {"perhaps", "", "2", "TRUE"})},
      {"parameter_list", forAll("finite numbers", {"", "1 2", "1 2 3 4 5", "a b c", "0 0 nan 1"})},
      {"parameter_frame",
       {{{"map_frame", ""}}, {{"map_frame", "/world"}}, {{"body_frame", "/body"}}}},
      {"parameter_rotation",
       {{{"extrinsic_rotation", "0 0 0 0"}}, {{"extrinsic_rotation", "0 0 0 2"}}}},
      {"parameter_order", wrongOrders()},
      {"parameter_history",
       {{{"pose_history", "0.2"}}, {{"pose_history", "1"}, {"max_pose_gap", "2"}}}},
      {"parameter_slide",
       {{{"slide_distance", "3.1"}}, {{"slide_distance", "0.4"}, {"map_size_x", "0.7"}}}},
      {"parameter_radius",
       {{{"inflation_radius", "6.5"}}, {{"inflation_radius", "0.7"}, {"resolution", "0.01"}}}},
      {"parameter_body_size", {{{"body_size_x", "0.5"}}, {{"clear_body", "true"}}}},
      {"parameter_window",
       {{{"map_size_x", "10000"}, {"map_size_y", "10000"}, {"map_size_z", "10000"}}}},
      {"parameter_body_frame",
       {{{"body_frame", ""}, {"pose_source", "pose"}},
        {{"body_frame", ""}, {"pose_source", "tf"}, {"extrinsics", "parameter"}},
        {{"body_frame", ""}, {"pose_source", "tf"}, {"sensors", "front lidar"}}}},
      {"parameter_sensor_name", sensorNames()},
      {"parameter_of_sensor", valuesOfASensor()},
      {"parameter_unknown_of_sensor",
       {{{"front/max_dpeth", "1"}, {"sensors", "front"}},
        {{"front/resolution", "1"}, {"sensors", "front"}}}},
      {"parameter_unknown", {{{"resolutoin", "0.1"}}, {{"", "1"}}}},
      {"tuning_out_of_range", outOfRange()},
      {"tuning_no_number", noNumbersToTune()},
      {"tuning_choice", noChoicesToTune()},
      {"tuning_order", wrongOrders()},
      {"tuning_beyond_window", {{{"slide_distance", "3.1"}}, {{"inflation_radius", "6.5"}}}},
      {"tuning_fixed", onlyTunable(oneForEach("1"), false)},
      {"tuning_of_all_sensors", ofAllSensors()},
      {"tuning_of_sensor",
       {{{"front/max_depth", "1001"}},
        {{"front/min_depth", "4"}, {"front/max_depth", "4"}},
        {{"front/time_offset", "3601"}}}},
      {"tuning_unknown", {{{"resolutoin", "0.1"}}, {{"front/max_dpeth", "1"}}, {{"", "1"}}}},
  };
  return all;
}

/// What a user would read; empty when the configuration is accepted.
std::string refusal(const Setting& setting, std::vector<std::string>* unknown) {
  MapperConfig mapper;
  NodeConfig node;
  try {
    *unknown = configure(ParameterMap(setting.begin(), setting.end()), &mapper, &node);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

bool isOfSeveralSensors(const std::string& id) {
  return id == "tuning_of_all_sensors" || id == "tuning_of_sensor";
}

/// Values of all parameters as text.
std::vector<std::string> valuesOf(MapperConfig mapper, NodeConfig node) {
  std::vector<std::string> values;
  for (const auto& list :
       {mapperParameters(&mapper), nodeParameters(&node), sensorParameters(&mapper, &node)}) {
    for (const Parameter& parameter : list) values.push_back(parameter.get());
  }
  return values;
}

/// What a user would read who tunes, beside something else that is allowed.
std::string refusalOfTuning(Setting setting, bool several_sensors) {
  MapperConfig mapper;
  NodeConfig node;
  const ParameterMap sensors = {{"sensors", "front lidar"}};
  configure(several_sensors ? sensors : ParameterMap(), &mapper, &node);
  const std::vector<std::string> before = valuesOf(mapper, node);
  setting.push_back({"publish_rate", "3"});
  try {
    tune(ParameterMap(setting.begin(), setting.end()), &mapper, &node);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(valuesOf(mapper, node), before);
    return error.what();
  }
  return "";
}

class ParameterFaultTest : public testing::TestWithParam<Fault> {
 protected:
  static void expectRefused(const Setting& setting) {
    std::vector<std::string> unknown;
    const std::string& id = GetParam().id;
    const bool is_tuning = id.find("tuning_") == 0;
    const std::string message =
        is_tuning ? refusalOfTuning(setting, isOfSeveralSensors(id)) : refusal(setting, &unknown);
    const auto& [name, value] = setting.front();
    // The window's size is named as one.
    const std::string named = name.substr(0, name.find_last_of('_'));
    EXPECT_NE(message.find("parameter"), std::string::npos) << name << " = " << value;
    EXPECT_NE(message.find(named), std::string::npos) << message;
    for (const std::string& part : GetParam().says) {
      EXPECT_NE(message.find(part), std::string::npos) << message << " lacks " << part;
    }
  }

  /// In its own range: with the defaults of others it need not make sense.
  static void expectInRange(const Setting& setting) {
    const auto& [name, value] = setting.front();
    for (const Parameter& parameter : allParameters()) {
      if (parameter.name != name) continue;
      EXPECT_NO_THROW(parameter.set(value)) << name << " " << value;
    }
  }

  static void expectUnknown(const Setting& setting) {
    std::vector<std::string> unknown;
    EXPECT_EQ(refusal(setting, &unknown), "");
    EXPECT_EQ(unknown, std::vector<std::string>{setting.front().first});
  }
};

TEST_P(ParameterFaultTest, IsRefusedWithItsNameAndWhatIsAllowed) {
  const Settings& tried = settings().at(GetParam().id);
  ASSERT_FALSE(tried.empty());
  for (const Setting& setting : tried) {
    if (GetParam().id == "parameter_at_its_limits") {
      expectInRange(setting);
    } else if (GetParam().id.find("parameter_unknown") == 0) {
      expectUnknown(setting);
    } else {
      expectRefused(setting);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, ParameterFaultTest, testing::ValuesIn(faultsOf("parameters")),
                         [](const auto& info) { return info.param.id; });

TEST(ParameterFaultsTest, EveryFaultHasItsRowAndEveryParameterItsRangeOrChoices) {
  EXPECT_EQ(settings().size(), faultsOf("parameters").size());
  for (const Parameter& parameter : allParameters()) {
    Range range;
    const bool is_text = parameter.allowed == "text";
    const bool has_choices = parameter.allowed.find(" or ") != std::string::npos;
    const bool is_list = parameter.allowed.find("a list of") == 0;
    EXPECT_TRUE(is_text || has_choices || is_list || parseRange(parameter.allowed, &range))
        << parameter.name << ": " << parameter.allowed;
  }
}

}  // namespace
}  // namespace fiimap
