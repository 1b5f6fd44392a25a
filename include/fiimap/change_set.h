#pragma once

#include <cstddef>
#include <vector>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What one update changed in the raw layer. Each voxel appears at most once, in one list only.
struct ChangeSet {
  /// Became occupied (the paper's lower array).
  std::vector<VoxelIndex> lower;
  /// Were occupied and became free (the paper's raise array), or unknown again.
  std::vector<VoxelIndex> raise;
  /// Were occupied when the window left them behind; outside of the window now.
  std::vector<VoxelIndex> forgotten;
  /// Parts of the window that it did not cover before it moved (they may overlap). Nothing is known
  /// in them yet, but obstacles beside them inflate voxels there.
  std::vector<VoxelBox> entered;

  /// The paper's change score (Section 5.2.3).
  std::size_t score() const { return lower.size() + raise.size(); }
  /// Whether nothing changed and the window did not move.
  bool empty() const {
    return lower.empty() && raise.empty() && forgotten.empty() && entered.empty();
  }
  /// Empties all lists and keeps their memory.
  void clear() {
    lower.clear();
    raise.clear();
    forgotten.clear();
    entered.clear();
  }
};

}  // namespace fiimap
