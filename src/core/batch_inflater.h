#pragma once

#include "fiimap/inflater.h"

namespace fiimap {

/// Clears the inflated plane and dilates every occupied voxel anew: what batch maps do, here for
/// the whole window. Cost follows the number of obstacles, not the change. The baseline.
class BatchInflater : public Inflater {
 public:
  explicit BatchInflater(const StructuringElement& element) : element_(element) {}

  void update(const ChangeSet& changes, SlidingGrid* grid) override;

 private:
  StructuringElement element_;
};

}  // namespace fiimap
