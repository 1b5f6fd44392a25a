#include "tuning_messages.h"

#include <locale>
#include <sstream>

namespace fiimap {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigDescription;

constexpr char kGroup[] = "Default";  // the name that clients expect of the outermost group

template <typename Entry, typename Value>
void append(const std::string& name, const Value& value, std::vector<Entry>* entries) {
  entries->emplace_back();
  entries->back().name = name;
  entries->back().value = value;
}

double toNumber(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0.0;
  stream >> number;
  return number;
}

/// Appends a value where those of its kind are.
void append(const Parameter& parameter, const std::string& value, Config* config) {
  switch (parameter.kind) {
    case ValueKind::kNumber:
      return append(parameter.name, toNumber(value), &config->doubles);
    case ValueKind::kInteger:
      return append(parameter.name, static_cast<int>(toNumber(value)), &config->ints);
    case ValueKind::kFlag:
      return append(parameter.name, value == "true", &config->bools);
    case ValueKind::kText:
      return append(parameter.name, value, &config->strs);
  }
}

Config emptyConfig() {
  Config config;
  config.groups.emplace_back();
  config.groups.back().name = kGroup;
  config.groups.back().state = true;
  return config;
}

/// As text; those of parameters without a range only have to be there.
void appendLimits(const Parameter& parameter, ConfigDescription* description) {
  std::string min, max;
  if (parameter.kind == ValueKind::kNumber) {
    min = toText(parameter.min);
    max = toText(parameter.max);
  } else if (parameter.kind == ValueKind::kInteger) {
    min = std::to_string(static_cast<int>(parameter.min));
    max = std::to_string(static_cast<int>(parameter.max));
  } else if (parameter.kind == ValueKind::kFlag) {
    min = "false";
    max = "true";
  }
  append(parameter, min, &description->min);
  append(parameter, max, &description->max);
}

std::string typeOf(const Parameter& parameter) {
  switch (parameter.kind) {
    case ValueKind::kNumber:
      return "double";
    case ValueKind::kInteger:
      return "int";
    case ValueKind::kFlag:
      return "bool";
    case ValueKind::kText:
      return "str";
  }
  return "";
}

/// The choices as the Python dictionary that clients evaluate; empty where there are none.
std::string editMethodOf(const Parameter& parameter) {
  std::string entries;
  for (const std::string& choice : parameter.choices) {
    const bool is_text = parameter.kind == ValueKind::kText;
    entries += entries.empty() ? "" : ", ";
    entries += "{'name': '" + choice + "', 'type': '" + typeOf(parameter) +
               "', 'value': " + (is_text ? "'" + choice + "'" : choice) + ", 'description': ''}";
  }
  if (entries.empty()) return "";
  return "{'enum_description': '" + parameter.allowed + "', 'enum': [" + entries + "]}";
}

}  // namespace

Config toConfig(const std::vector<Parameter>& parameters) {
  Config config = emptyConfig();
  for (const Parameter& parameter : parameters) append(parameter, parameter.get(), &config);
  return config;
}

ConfigDescription toDescription(const std::vector<Parameter>& parameters) {
  ConfigDescription description;
  description.dflt = toConfig(parameters);
  description.min = description.max = emptyConfig();
  dynamic_reconfigure::Group group;
  group.name = kGroup;
  for (const Parameter& parameter : parameters) {
    appendLimits(parameter, &description);
    group.parameters.emplace_back();
    group.parameters.back().name = parameter.name;
    group.parameters.back().type = typeOf(parameter);
    group.parameters.back().description = parameter.meaning + ": " + parameter.allowed;
    group.parameters.back().edit_method = editMethodOf(parameter);
  }
  description.groups.push_back(group);
  return description;
}

ParameterMap toParameterMap(const Config& config) {
  ParameterMap values;
  for (const auto& entry : config.bools) values[entry.name] = entry.value ? "true" : "false";
  for (const auto& entry : config.ints) values[entry.name] = std::to_string(entry.value);
  for (const auto& entry : config.doubles) values[entry.name] = toText(entry.value);
  for (const auto& entry : config.strs) values[entry.name] = entry.value;
  return values;
}

}  // namespace fiimap
