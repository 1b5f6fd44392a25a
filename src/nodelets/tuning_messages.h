#pragma once

#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include "fiimap/parameters.h"

namespace fiimap {

/// Parameters in the messages of dynamic_reconfigure, which rqt_reconfigure and dynparam read: one
/// group of all, with names as they are here.

/// Their values.
dynamic_reconfigure::Config toConfig(const std::vector<Parameter>& parameters);

/// What they are, with their values as defaults.
dynamic_reconfigure::ConfigDescription toDescription(const std::vector<Parameter>& parameters);

/// Values of whatever type as text, by name.
ParameterMap toParameterMap(const dynamic_reconfigure::Config& config);

}  // namespace fiimap
