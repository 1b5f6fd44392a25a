#include "flight_settings.h"

#include <stdexcept>
#include <vector>

#include "fiimap/ros/parameter_sources.h"

namespace fiimap {
namespace {

void apply(const std::string& part, const ParameterMap& values, FlightSettings* settings) {
  std::vector<std::string> unknown;
  if (part == "simulator") {
    unknown = applyParameters(values, sim::simulatorParameters(&settings->simulator));
  } else if (part == "map") {
    unknown = applyParameters(values, mapperParameters(&settings->map));
  } else if (part == "planner") {
    unknown = configure(values, &settings->planner);
  } else {
    throw std::invalid_argument("'" + part + "' must be simulator, map or planner");
  }
  if (!unknown.empty()) {
    throw std::invalid_argument("parameter " + unknown.front() + " is none of the " + part + "'s");
  }
}

}  // namespace

void applyFile(const std::string& part, const std::string& file, FlightSettings* settings) {
  apply(part, parameterMapFromYaml(file), settings);
}

void applySetting(const std::string& setting, FlightSettings* settings) {
  const std::size_t dot = setting.find('.');
  const std::size_t equals = setting.find('=');
  if (dot == std::string::npos || equals == std::string::npos || dot > equals) {
    throw std::invalid_argument("'" + setting + "' must be PART.NAME=VALUE");
  }
  const std::string name = setting.substr(dot + 1, equals - dot - 1);
  apply(setting.substr(0, dot), {{name, setting.substr(equals + 1)}}, settings);
}

void validate(const FlightSettings& settings) {
  settings.simulator.validate();
  settings.map.validate();
}

}  // namespace fiimap
