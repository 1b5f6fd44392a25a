#pragma once

#include <string>
#include <vector>

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval truth`: compares the map of a synthetic recording with the scene that it was
/// rendered from.
struct TruthOptions {
  InputOptions input;
  std::string scene;                ///< file of the scene, as data/README.md describes it
  std::vector<double> resolutions;  ///< m; empty: that of the configuration
  int snapshots = 10;               ///< how often to compare, evenly over the recording
  /// Where to write the occupied voxels of the last map at the first resolution with their distance
  /// from the exact surface, as CSV; empty: nowhere.
  std::string voxels;
  bool csv = false;  ///< print the table as CSV
};

/// \return 0. \throws std::exception with a message for the user when input or settings are bad, or
/// no scan could be integrated.
int evaluateTruth(const TruthOptions& options);

}  // namespace fiimap
