#pragma once

#include <memory>

#include "fiimap/change_set.h"
#include "fiimap/mapper_config.h"
#include "fiimap/sliding_grid.h"

namespace fiimap {

/// Keeps the inflated plane equal to its definition (invariant 1): inflated(v) <=> some occupied u
/// of the window has v - u in the structuring element. Not thread-safe (keeps scratch memory).
class Inflater {
 public:
  virtual ~Inflater() = default;

  /// Restores the definition after the occupied plane changed by `changes` and the window moved.
  /// The inflated plane must have fulfilled the definition before these changes.
  virtual void update(const ChangeSet& changes, SlidingGrid* grid) = 0;
};

/// Makes the method that the configuration asks for, for a grid of the configured size.
/// \param config validated.
std::unique_ptr<Inflater> makeInflater(const MapperConfig& config);

/// Computes the inflated plane anew, whatever it held, for instance after a change of radius.
void rebuildInflation(Inflater* inflater, SlidingGrid* grid);

}  // namespace fiimap
