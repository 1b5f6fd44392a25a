#include "fiimap/ros/tuning.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "sensor_parameters.h"

namespace fiimap {
namespace {

void appendTunable(const std::vector<Parameter>& from, const std::set<std::string>& without,
                   std::vector<Parameter>* to) {
  std::copy_if(from.begin(), from.end(), std::back_inserter(*to), [&](const Parameter& parameter) {
    return parameter.tunable && without.count(parameter.name) == 0;
  });
}

/// Names of what a sensor may have of its own.
std::set<std::string> namesOfSensors() {
  MapperConfig mapper;
  NodeConfig node;
  std::set<std::string> names;
  for (const auto& list : {parametersOfSensor(&node, ""), readingParameters(&mapper)}) {
    for (const Parameter& parameter : list) names.insert(parameter.name);
  }
  return names;
}

bool isAmong(const std::string& name, const std::vector<Parameter>& parameters) {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&name](const Parameter& parameter) { return parameter.name == name; });
}

[[noreturn]] void refuseUnknown(const std::string& name, MapperConfig* mapper, NodeConfig* node) {
  const bool is_known = isAmong(name, mapperParameters(mapper)) ||
                        isAmong(name, nodeParameters(node)) ||
                        isAmong(name, sensorParameters(mapper, node));
  if (!is_known) throw std::invalid_argument("parameter " + name + " is unknown");
  if (!node->sensors.empty() && namesOfSensors().count(name) != 0) {
    throw std::invalid_argument("parameter " + name + ": each sensor has its own: " +
                                node->sensors.front().prefix() + name);
  }
  throw std::invalid_argument("parameter " + name +
                              " cannot change while the node runs: set it and start the node anew");
}

}  // namespace

std::vector<Parameter> tunableParameters(MapperConfig* mapper, NodeConfig* node) {
  const std::set<std::string> of_sensors =
      node->sensors.empty() ? std::set<std::string>() : namesOfSensors();
  std::vector<Parameter> all;
  appendTunable(mapperParameters(mapper), of_sensors, &all);
  appendTunable(nodeParameters(node), of_sensors, &all);
  appendTunable(sensorParameters(mapper, node), {}, &all);
  return all;
}

void tune(const ParameterMap& changes, MapperConfig* mapper, NodeConfig* node) {
  MapperConfig tuned_mapper = *mapper;
  NodeConfig tuned_node = *node;
  const std::vector<std::string> unknown =
      applyParameters(changes, tunableParameters(&tuned_mapper, &tuned_node));
  if (!unknown.empty()) refuseUnknown(unknown.front(), &tuned_mapper, &tuned_node);
  validate(tuned_mapper, tuned_node);
  *mapper = tuned_mapper;
  *node = tuned_node;
}

}  // namespace fiimap
