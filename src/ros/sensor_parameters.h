#pragma once

#include <string>
#include <vector>

#include "fiimap/ros/node_config.h"

namespace fiimap {

constexpr double kMaxSeconds = 3600.0;

/// All parameters of a SensorConfig but its name, bound to `config`.
std::vector<Parameter> parametersOfSensor(SensorConfig* config, const std::string& prefix);

/// The parameter `sensors`: their names; all else of them has its default then.
Parameter sensorsParameter(std::vector<SensorConfig>* sensors);

/// Names, separated by spaces.
std::string joinNames(const std::vector<SensorConfig>& sensors);

}  // namespace fiimap
