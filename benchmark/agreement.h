#pragma once

#include <string>

#include "recording.h"

namespace fiimap::bench {

/// Compares what the methods make of the same frames: comparing the speed of methods that do
/// different things says nothing. Prints what it finds.
/// - Batch inflation over bytes and each of our inflaters: equal voxel by voxel, else it fails.
/// - Occupied voxels of the baselines and ours: they follow different rules along rays, so it fails
///   only when either lacks, within one voxel, more than a small share of what the other has.
/// \return whether all agree.
bool checkAgreement(const Recording& recording);

}  // namespace fiimap::bench
