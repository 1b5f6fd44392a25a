#pragma once

#include <cstddef>

#include "fiimap/mapper_config.h"

namespace fiimap {

/// What a map takes when all of its window has been seen, and one scan over the whole update range
/// marks its voxels; bytes. Snapshots come on top: up to 3/11 of it for each one that is held while
/// all of the map changes. \param config its single parameters are in range.
double memoryNeed(const MapperConfig& config);

/// \throws std::invalid_argument with the amounts, when the need is above memory_limit, or above
/// the machine's memory where memory_limit is 0; or when the update range has more columns than can
/// be addressed.
void requireMemory(const MapperConfig& config);

}  // namespace fiimap
