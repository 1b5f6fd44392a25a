#pragma once

#include <cstddef>
#include <vector>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What one scan changed in the raw layer. Each voxel appears at most once, in one list only.
struct ChangeSet {
  /// Became occupied (the paper's lower array).
  std::vector<VoxelIndex> lower;
  /// Were occupied and became free (the paper's raise array).
  std::vector<VoxelIndex> raise;
  /// Were occupied when the window left them behind; outside of the window now.
  std::vector<VoxelIndex> forgotten;

  /// The paper's change score (Section 5.2.3).
  std::size_t score() const { return lower.size() + raise.size(); }
  bool empty() const { return lower.empty() && raise.empty() && forgotten.empty(); }
  void clear() {
    lower.clear();
    raise.clear();
    forgotten.clear();
  }
};

}  // namespace fiimap
