#include "fiimap/ros/parameter_sources.h"

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace fiimap {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("parameter " + name + ": " + what);
}

/// Lists are joined by spaces.
void append(const std::string& name, const std::string& element, bool is_text, std::string* list) {
  if (is_text && (element.empty() || element.find_first_of(" \t\n") != std::string::npos)) {
    refuse(name, "'" + element + "' in a list must be a number or a word");
  }
  *list += (list->empty() ? "" : " ") + element;
}

std::string toText(const std::string& name, XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return fiimap::toText(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: {
      std::string joined;
      for (int i = 0; i < value.size(); ++i) {
        const bool is_text = value[i].getType() == XmlRpc::XmlRpcValue::TypeString;
        append(name, toText(name, value[i]), is_text, &joined);
      }
      return joined;
    }
    default:
      refuse(name, "must be a number, text, true or false, or a list of numbers");
  }
}

/// YAML's plain yes, on, True, ... as rosparam understands them.
std::string toText(const YAML::Node& scalar) {
  const std::string text = scalar.Scalar();
  const bool quoted = scalar.Tag() == "!";
  if (quoted) return text;
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == "true" || lower == "yes" || lower == "on") return "true";
  if (lower == "false" || lower == "no" || lower == "off") return "false";
  return text;
}

std::string toText(const std::string& name, const YAML::Node& node) {
  if (node.IsScalar()) return toText(node);
  if (!node.IsSequence()) refuse(name, "must be a number, text, true or false, or a list");
  std::string joined;
  for (std::size_t i = 0; i < node.size(); ++i) {
    append(name, toText(name, node[i]), node[i].IsScalar(), &joined);
  }
  return joined;
}

/// What stands where no value can be read, for the message that refuses it.
std::string asWritten(const XmlRpc::XmlRpcValue& value) {
  std::ostringstream text;
  value.write(text);
  return text.str();
}

std::string asWritten(const YAML::Node& node) {
  YAML::Emitter text;
  text << node;
  return text.c_str();
}

/// A sensor's parameters, or what others keep there: of that, the name alone lets the caller say
/// that it is unknown, whatever its value is.
template <typename Value>
void addEntry(const std::string& name, const Value& value, ParameterMap* values) {
  try {
    (*values)[name] = toText(name, value);
  } catch (const std::invalid_argument&) {
    (*values)[name] = asWritten(value);
  }
}

void addNamespace(const std::string& name, XmlRpc::XmlRpcValue& entries, ParameterMap* values) {
  for (auto& [key, value] : entries) addEntry(name + '/' + key, value, values);
}

void addNamespace(const std::string& name, const YAML::Node& entries, ParameterMap* values) {
  for (const auto& entry : entries) {
    addEntry(name + '/' + entry.first.as<std::string>(), entry.second, values);
  }
}

}  // namespace

ParameterMap parameterMapFromRos(const ros::NodeHandle& node) {
  ParameterMap values;
  XmlRpc::XmlRpcValue all;
  const bool found = node.getParam(node.getNamespace(), all);
  if (!found || all.getType() != XmlRpc::XmlRpcValue::TypeStruct) return values;
  for (auto& [name, value] : all) {
    if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
      values[name] = toText(name, value);
    } else {
      addNamespace(name, value, &values);
    }
  }
  return values;
}

ParameterMap parameterMapFromYaml(const std::string& file) {
  ParameterMap values;
  try {
    const YAML::Node all = YAML::LoadFile(file);
    if (all.IsNull()) return values;
    if (!all.IsMap()) throw std::invalid_argument("must hold 'name: value' lines");
    for (const auto& entry : all) {
      const std::string name = entry.first.as<std::string>();
      if (entry.second.IsMap()) {
        addNamespace(name, entry.second, &values);
      } else {
        values[name] = toText(name, entry.second);
      }
    }
  } catch (const std::exception& error) {
    throw std::invalid_argument(file + ": " + error.what());
  }
  return values;
}

}  // namespace fiimap
