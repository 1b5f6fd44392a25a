#pragma once

#include <cstdint>

#include "fiimap/snapshot.h"

namespace fiimap {

/// Compares the inflated plane of a snapshot with brute force: every occupied voxel of the window
/// is dilated by the definition of its structuring element (structuring_element.h), with code of
/// its own. \return number of voxels of the window that differ.
std::int64_t countInflationMismatches(const Snapshot& snapshot);

}  // namespace fiimap
