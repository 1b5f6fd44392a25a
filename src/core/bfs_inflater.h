#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/inflater.h"

namespace fiimap {

/// The paper's Algorithms 1 and 2 (Section 4), made exact: breadth-first searches of connectivity
/// 6, 18 or 26 around raised and lowered voxels.
///
/// Where the print is wrong: a raised voxel clears what lies within the structuring element E, not
/// within 2 L; the obstacles that may have to restore something lie within E + E; and each search
/// visits the whole of its region, because stopping early loses voxels. A search runs inside its
/// region (E or E + E), which is connected whatever the connectivity, so the result does not depend
/// on the latter.
class BfsInflater : public Inflater {
 public:
  /// \param connectivity 6, 18 or 26.
  BfsInflater(const StructuringElement& element, int connectivity);

  void update(const ChangeSet& changes, SlidingGrid* grid) override;

 private:
  /// Set of offsets in which a search runs, as a cube of flags.
  class Region {
   public:
    explicit Region(int reach);
    void insert(const VoxelIndex& offset) { flags_[indexOf(offset)] = 1; }
    bool contains(const VoxelIndex& offset) const {
      return offset.cwiseAbs().maxCoeff() <= reach_ && flags_[indexOf(offset)] != 0;
    }
    std::size_t indexOf(const VoxelIndex& offset) const;
    std::size_t cells() const { return flags_.size(); }
    int reach() const { return reach_; }

   private:
    int reach_;
    std::vector<std::uint8_t> flags_;
  };

  void insertDoubled(const StructuringElement& element);
  void raise(const VoxelIndex& source, SlidingGrid* grid);
  template <typename Visitor>
  void search(const Region& region, Visitor&& visit);

  std::vector<VoxelIndex> neighbours_;
  Region element_;
  Region doubled_element_;
  std::vector<std::uint8_t> visited_;
  std::vector<VoxelIndex> queue_;
  std::vector<VoxelIndex> lower_;  // the paper's lower array with the temp array appended
};

}  // namespace fiimap
