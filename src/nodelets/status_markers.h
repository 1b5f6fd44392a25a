#pragma once

#include <string>

#include <visualization_msgs/MarkerArray.h>

#include "mapping_thread.h"

namespace fiimap {

/// What rviz's own displays do not show of a map, in the map frame:
///  - `cell`: the vehicle's voxel in the colour of its state, green free, grey unknown, orange
///    inflated, red occupied, black outside of the window;
///  - `statistics`: text above the vehicle: time of the scan, sizes, drops, state of the cell;
///  - `appeared` and `gone`: voxels that became occupied (red) and those that no longer are (blue),
///    as far as they lie in the window.
/// Colours differ for the colour-blind, too.
/// \param before the snapshot that was shown last; null: none, so that nothing appeared.
visualization_msgs::MarkerArray toStatusMarkers(const MapUpdate& update, const Snapshot* before,
                                                const std::string& map_frame);

/// Takes all of them away.
visualization_msgs::MarkerArray noStatusMarkers(const std::string& map_frame);

}  // namespace fiimap
