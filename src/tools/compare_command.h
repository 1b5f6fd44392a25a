#pragma once

#include <string>
#include <vector>

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval compare`: the time of every update with our map and with others, against the number
/// of the update and its change score (the paper's Figures 7 and 8).
struct CompareOptions {
  InputOptions input;
  /// Names of ways to inflate (inflation_replay.h) and of whole maps (mapping_method.h).
  std::vector<std::string> methods = {"incremental", "bfs6", "byte_batch",
                                      "fiimap",      "ego",  "octomap"};
  bool csv = false;  ///< print the table of all updates as CSV
};

/// \return 0. \throws std::exception with a message for the user when input or settings are bad, or
/// no scan could be integrated.
int compareMethods(const CompareOptions& options);

}  // namespace fiimap
