#pragma once

#include <fiimap/OtherVehicles.h>

#include <string>
#include <vector>

#include "fiimap/ignored_volumes.h"

namespace fiimap {

/// \throws std::invalid_argument, with the reason, for what the messages' definitions do not allow.
std::vector<IgnoredSphere> toIgnoredSpheres(const OtherVehicles& message,
                                            const std::string& map_frame);

}  // namespace fiimap
