#pragma once

#include <string>

#include "doctor/observation.h"

namespace fiimap {

/// Looks at a part of a bag; static transforms are taken from before it too.
/// \param start, seconds the part, from the bag's beginning, s.
/// \throws std::invalid_argument that tells why the bag cannot be read.
Observation observeBag(const std::string& file, double start, double seconds);

}  // namespace fiimap
