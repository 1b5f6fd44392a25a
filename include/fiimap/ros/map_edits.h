#pragma once

#include <fiimap/ClearBox.h>
#include <fiimap/LoadMap.h>

#include "fiimap/mapper.h"
#include "fiimap/ros/map_files.h"

namespace fiimap {

// What services do to the map. What is not allowed throws std::invalid_argument with the reason,
// and leaves the map as it was.

/// Makes the voxels of a box unknown or free.
ClearBox::Response clearBox(const ClearBox::Request& request, Mapper* mapper);

/// Writes a saved map over the window, which gets its place where it has none.
/// \param map that was read; \param request for the vehicle's position.
LoadMap::Response loadMap(const SavedMap& map, const LoadMap::Request& request, Mapper* mapper);

}  // namespace fiimap
