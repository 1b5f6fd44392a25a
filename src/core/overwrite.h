#pragma once

#include "fiimap/change_set.h"
#include "fiimap/log_odds.h"
#include "fiimap/sliding_grid.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// Makes the voxels of a box that lie in the window unknown, or free or occupied with the least or
/// the highest log-odds, and appends those that changed to changes->lower and changes->raise. The
/// inflated plane is left to the Inflater.
/// \param state not kOutside.
void overwrite(const VoxelBox& box, Occupancy state, const LogOdds& log_odds, SlidingGrid* grid,
               ChangeSet* changes);

}  // namespace fiimap
