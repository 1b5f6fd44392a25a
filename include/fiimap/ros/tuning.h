#pragma once

#include <vector>

#include "fiimap/ros/node_config.h"

namespace fiimap {

/// The parameters that may change while the node runs, bound to the configurations, in the order of
/// config/default.yaml. With several sensors, what a sensor may have of its own is there for each
/// of them, under its full name ("front/max_depth"), and not for all.
std::vector<Parameter> tunableParameters(MapperConfig* mapper, NodeConfig* node);

/// Sets some of them: all or none.
/// \throws std::invalid_argument, with both configurations unchanged, that names the parameter, its
/// value and what is allowed; also for one that is unknown or may not change.
void tune(const ParameterMap& changes, MapperConfig* mapper, NodeConfig* node);

}  // namespace fiimap
