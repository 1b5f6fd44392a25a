#pragma once

#include <string>
#include <vector>

#include "fiimap/parameters.h"

namespace fiimap {

/// Settings of a command line by name; the last of a name wins.
/// \param settings "name=value" each.
/// \throws std::invalid_argument for one that is not.
ParameterMap parseSettings(const std::vector<std::string>& settings);

}  // namespace fiimap
