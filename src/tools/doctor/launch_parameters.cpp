#include "doctor/launch_parameters.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

namespace fiimap {
namespace {

bool hasArgument(const std::string& name) {
  return name == "sensor" || name == "pose_source" || name == "map_frame" || name == "body_frame";
}

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

bool isWord(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.';
  });
}

bool isList(const std::string& parameter) {
  const std::string name = parameter.substr(parameter.rfind('/') + 1);
  return name == "extrinsic_translation" || name == "extrinsic_rotation" || name == "sensors";
}

std::string inQuotes(const std::string& text) {
  std::string inner;
  for (const char c : text)
    inner += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return '"' + inner + '"';
}

/// A parameter's text as a value in YAML; in lists, words are separated by spaces.
std::string yamlValue(const std::string& parameter, const std::string& text) {
  if (!isList(parameter)) return isNumber(text) || isWord(text) ? text : inQuotes(text);
  std::istringstream words(text);
  std::string list;
  for (std::string word; words >> word;) list += (list.empty() ? "" : ", ") + word;
  return '[' + list + ']';
}

/// All parameters that are not a sensor's own, with their values.
ParameterMap valuesOf(MapperConfig mapper, NodeConfig node) {
  ParameterMap values;
  for (const auto& list : {mapperParameters(&mapper), nodeParameters(&node)}) {
    for (const Parameter& parameter : list) values[parameter.name] = parameter.get();
  }
  return values;
}

/// What the sensors have of their own that differs from what is set for all.
ParameterMap ownParameters(MapperConfig mapper, NodeConfig node) {
  const ParameterMap of_all = valuesOf(mapper, node);
  ParameterMap own;
  for (const Parameter& parameter : sensorParameters(&mapper, &node)) {
    const std::string value = parameter.get();
    if (value != of_all.at(parameter.name.substr(parameter.name.find('/') + 1))) {
      own[parameter.name] = value;
    }
  }
  return own;
}

}  // namespace

ParameterMap furtherParameters(const Observation& seen, const MapSetup& setup) {
  ParameterMap parameters = setup.changes;
  const ParameterMap values = valuesOf(setup.mapper, setup.node);
  if (seen.map) {
    const ParameterMap defaults = valuesOf(MapperConfig(), NodeConfig());
    for (const auto& [name, value] : values) {
      if (value != defaults.at(name)) parameters[name] = value;
    }
  }
  if (!setup.sensors.empty()) {
    parameters["sensors"] = values.at("sensors");
    for (const auto& [name, value] : ownParameters(setup.mapper, setup.node)) {
      parameters[name] = value;
    }
  }
  for (auto each = parameters.begin(); each != parameters.end();) {
    each = hasArgument(each->first) ? parameters.erase(each) : std::next(each);
  }
  return parameters;
}

std::vector<std::string> keptParameters(const Observation& seen, const MapSetup& setup) {
  std::vector<std::string> kept;
  if (!seen.map) return kept;
  for (const auto& [name, value] : furtherParameters(seen, setup)) {
    const bool is_changed = setup.changes.count(name) != 0;
    if (!is_changed && seen.map->parameters.count(name) != 0) kept.push_back(name);
  }
  return kept;
}

std::string toYaml(const ParameterMap& parameters) {
  std::string of_all;
  std::map<std::string, std::string> of_sensors;
  const auto append = [](const std::string& name, const std::string& value, std::string* to) {
    *to += (to->empty() ? "" : ", ") + name + ": " + value;
  };
  for (const auto& [name, value] : parameters) {
    const std::size_t slash = name.find('/');
    std::string* to = slash == std::string::npos ? &of_all : &of_sensors[name.substr(0, slash)];
    append(name.substr(slash + 1), yamlValue(name, value), to);  // npos + 1 is 0
  }
  for (const auto& [sensor, own] : of_sensors) append(sensor, '{' + own + '}', &of_all);
  return of_all.empty() ? "" : '{' + of_all + '}';
}

}  // namespace fiimap
