#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include "fiimap/parameters.h"
#include "fiimap/ros/node_config.h"

namespace fiimap {

/// Changes parameters while the node runs, as dynamic_reconfigure's clients ask for it: its
/// services and topics, made from the parameters' own tables instead of a .cfg file. Parameters of
/// a sensor have theirs in the namespace of its name. A request is granted as a whole, and the
/// parameter server follows; or it is refused as a whole, with a warning of why, and answered with
/// the values that hold.
class TuningServer {
 public:
  /// Puts a configuration into effect and returns when it is. \return false when the node is
  /// shutting down. Throws what refuses it.
  using Apply = std::function<bool(const MapperConfig&, const NodeConfig&)>;

  /// \param node private to the nodelet; its callbacks wait for `apply`, and have ended before this
  /// object does.
  /// \param name of the nodelet, for messages to the user.
  /// \param mapper, node_config in effect.
  TuningServer(const ros::NodeHandle& node, const std::string& name, const MapperConfig& mapper,
               const NodeConfig& node_config, Apply apply);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;

  /// Of the map, or of a sensor.
  struct Endpoint {
    std::string prefix;  ///< of its parameters' full names
    ros::Publisher descriptions, updates;
    ros::ServiceServer service;
  };

  void open(const SensorConfig& sensor);
  void answer(Endpoint* endpoint, const Request& request, Response* response);
  void change(const ParameterMap& values);
  std::vector<Parameter> parametersOf(const Endpoint& endpoint);

  ros::NodeHandle node_;
  std::string name_;
  Apply apply_;
  std::mutex mutex_;  // guards what is in effect, and its changes
  MapperConfig mapper_;
  NodeConfig node_config_;
  std::deque<Endpoint> endpoints_;  // stay where they are
};

}  // namespace fiimap
