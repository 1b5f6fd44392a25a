#pragma once

#include <fiimap/MapChanges.h>

#include <string>

#include "fiimap/snapshot.h"

namespace fiimap {

/// The message by which a MapChangesReader that has one map gets another. Costs time by what
/// changed.
/// \param before the map that it has, of the same mapper; null: a keyframe.
MapChanges toMapChanges(const Snapshot& snapshot, const Snapshot* before,
                        const std::string& map_frame);

/// A keyframe that says that there is no map.
MapChanges toEmptyKeyframe(const std_msgs::Header& header);

}  // namespace fiimap
