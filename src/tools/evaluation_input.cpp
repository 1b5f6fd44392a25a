#include "evaluation_input.h"

#include <stdexcept>

#include "bag_check.h"
#include "fiimap/ros/parameter_sources.h"
#include "output_file.h"
#include "settings.h"

namespace fiimap {

EvaluationInput::EvaluationInput(const InputOptions& options) : options_(options) {
  const ParameterMap given = readSettings();
  openBag(options.bag, &bag_);
  topics_ = chooseTopics(bag_, given, topics_, &node_);
  if (!options.json.empty()) checkWritable(options.json);
}

/// \return what the user set, by name.
ParameterMap EvaluationInput::readSettings() {
  ParameterMap given;
  if (!options_.config.empty()) given = parameterMapFromYaml(options_.config);
  for (const auto& [name, value] : parseSettings(options_.settings)) given[name] = value;
  ParameterMap of_topics;
  for (const std::string& name : configure(given, &mapper_, &node_)) {
    const auto value = given.find(name);  // not that of a namespace
    of_topics[name] = value == given.end() ? "" : value->second;
  }
  const std::vector<std::string> unknown = applyParameters(of_topics, topics_.parameters(node_));
  if (!unknown.empty()) {
    throw std::invalid_argument("unknown parameter " + unknown.front() +
                                ": fiimap_eval parameters lists all" +
                                hintForUnknown(unknown.front()));
  }
  return given;
}

void EvaluationInput::requireOneSensor() const {
  if (node_.sensors.empty()) return;
  throw std::invalid_argument(
      "parameter sensors: several sensors go into the map of run and health alone; leave it out "
      "and name the topic of one");
}

void EvaluationInput::writeJson(nlohmann::json figures) const {
  if (options_.json.empty()) return;
  figures["bag"] = options_.bag;
  MapperConfig mapper = mapper_;
  NodeConfig node = node_;
  BagTopics topics = topics_;
  for (const auto& list : {mapperParameters(&mapper), nodeParameters(&node),
                           sensorParameters(&mapper, &node), topics.parameters(node)}) {
    for (const Parameter& parameter : list) figures["parameters"][parameter.name] = parameter.get();
  }
  writeWhole(options_.json, figures.dump(2) + '\n');
}

}  // namespace fiimap
