#pragma once

#include <string>

#include "fiimap/parameters.h"

namespace ros {
class NodeHandle;
}

namespace fiimap {

/// All parameters in the namespace of `node`, as text; lists are joined by spaces, those of sensors
/// are named "front/max_depth".
/// \throws std::invalid_argument for values of a type that no parameter has.
ParameterMap parameterMapFromRos(const ros::NodeHandle& node);

/// The entries of a YAML file as `rosparam load` would set them, as text, likewise.
/// \throws std::invalid_argument when the file cannot be read or is no map.
ParameterMap parameterMapFromYaml(const std::string& file);

}  // namespace fiimap
