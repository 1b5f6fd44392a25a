#pragma once

#include <fiimap/GetBox.h>

#include <string>

#include "fiimap/snapshot.h"

namespace fiimap {

/// Answers a query for the voxels of a box on one snapshot. A box that is not finite, empty, too
/// far away or too large is refused with the reason in the answer.
GetBox::Response queryBox(const Snapshot& snapshot, const GetBox::Request& request,
                          const std::string& map_frame);

}  // namespace fiimap
