#include "tuning_server.h"

#include <cstddef>
#include <stdexcept>
#include <utility>

#include <ros/console.h>
#include <boost/function.hpp>

#include "fiimap/ros/tuning.h"
#include "tuning_messages.h"

namespace fiimap {
namespace {

constexpr int kTuningQueue = 10;
constexpr bool kLatch = true;

/// Of the type that a user would write into a file.
void setOnServer(const Parameter& parameter, const ros::NodeHandle& node) {
  const dynamic_reconfigure::Config config = toConfig({parameter});
  for (const auto& entry : config.doubles) node.setParam(entry.name, entry.value);
  for (const auto& entry : config.ints) node.setParam(entry.name, entry.value);
  for (const auto& entry : config.bools) node.setParam(entry.name, static_cast<bool>(entry.value));
  for (const auto& entry : config.strs) node.setParam(entry.name, entry.value);
}

}  // namespace

TuningServer::TuningServer(const ros::NodeHandle& node, const std::string& name,
                           const MapperConfig& mapper, const NodeConfig& node_config, Apply apply)
    : node_(node),
      name_(name),
      apply_(std::move(apply)),
      mapper_(mapper),
      node_config_(node_config) {
  open(SensorConfig());
  for (const SensorConfig& sensor : node_config_.sensors) open(sensor);
}

/// \param sensor without a name: the map.
void TuningServer::open(const SensorConfig& sensor) {
  endpoints_.emplace_back();
  Endpoint* const endpoint = &endpoints_.back();
  endpoint->prefix = sensor.prefix();
  ros::NodeHandle node(node_, sensor.name);
  endpoint->descriptions = node.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", kTuningQueue, kLatch);
  endpoint->updates =
      node.advertise<dynamic_reconfigure::Config>("parameter_updates", kTuningQueue, kLatch);
  const std::vector<Parameter> parameters = parametersOf(*endpoint);
  endpoint->descriptions.publish(toDescription(parameters));
  endpoint->updates.publish(toConfig(parameters));
  const boost::function<bool(Request&, Response&)> callback = [this, endpoint](Request& request,
                                                                               Response& response) {
    answer(endpoint, request, &response);
    return true;
  };
  endpoint->service = node.advertiseService("set_parameters", callback);
}

void TuningServer::answer(Endpoint* endpoint, const Request& request, Response* response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ParameterMap values;
  for (const auto& [name, value] : toParameterMap(request.config)) {
    values[endpoint->prefix + name] = value;
  }
  try {
    change(values);
  } catch (const std::exception& error) {
    ROS_WARN_NAMED(name_, "nothing is changed: %s", error.what());
  }
  response->config = toConfig(parametersOf(*endpoint));
  // Also after a refusal: the form of rqt_reconfigure shows what was asked for until then.
  endpoint->updates.publish(response->config);
}

/// \param values by full names.
void TuningServer::change(const ParameterMap& values) {
  MapperConfig mapper = mapper_;
  NodeConfig node_config = node_config_;
  tune(values, &mapper, &node_config);
  if (!apply_(mapper, node_config)) throw std::runtime_error("the node is shutting down");

  const std::vector<Parameter> before = tunableParameters(&mapper_, &node_config_);
  const std::vector<Parameter> after = tunableParameters(&mapper, &node_config);
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i].get() == before[i].get()) continue;
    ROS_INFO_NAMED(name_, "parameter %s = '%s', was '%s'", after[i].name.c_str(),
                   after[i].get().c_str(), before[i].get().c_str());
    setOnServer(after[i], node_);
  }
  mapper_ = mapper;
  node_config_ = node_config;
}

/// Under their names in its namespace.
std::vector<Parameter> TuningServer::parametersOf(const Endpoint& endpoint) {
  std::vector<Parameter> own;
  for (Parameter& parameter : tunableParameters(&mapper_, &node_config_)) {
    const std::size_t name = parameter.name.find('/') + 1;  // 0 where there is no namespace
    if (parameter.name.substr(0, name) != endpoint.prefix) continue;
    parameter.name.erase(0, name);
    own.push_back(std::move(parameter));
  }
  return own;
}

}  // namespace fiimap
