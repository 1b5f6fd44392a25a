#pragma once

#include <string>
#include <vector>

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval sweep`: what inflation costs by resolution, radius, shape and method (the paper's
/// Figure 6). Every method is fed with the same changes of the occupied layer.
struct SweepOptions {
  InputOptions input;
  std::vector<double> resolutions = {0.2, 0.1, 0.05};          ///< m
  std::vector<int> reaches = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};  ///< the paper's L, voxels
  std::vector<std::string> methods;                            ///< empty: all
  std::vector<std::string> shapes = {"ball"};
  /// CPU time after which a series ends, s: searches of many voxels take minutes.
  double seconds = 5.0;
  bool csv = false;  ///< print the table as CSV
};

/// \return 0. \throws std::exception with a message for the user when input or settings are bad, or
/// no scan could be integrated.
int sweepInflation(const SweepOptions& options);

}  // namespace fiimap
