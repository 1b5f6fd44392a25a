#pragma once

#include <string>

#include "doctor/observation.h"

namespace fiimap {

/// Listens to every topic of the graph that may be an input of a map, and to what a mapping node
/// says if one runs. A master must answer.
/// \param map name of the mapping node to look at; empty: any.
/// \param seconds how long, by the machine's clock.
Observation observeGraph(const std::string& map, double seconds);

}  // namespace fiimap
