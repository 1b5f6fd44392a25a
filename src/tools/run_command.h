#pragma once

#include <string>

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval run`: builds the map of a bag as the nodelet would, as fast as it can.
struct RunOptions {
  InputOptions input;
  std::string save;  ///< PREFIX of PREFIX_occupied.pcd, ...; empty: nowhere
  int verify = 0;    ///< compare with brute force at every n-th scan; 0: never
};

/// \return 0; 1 when a comparison with brute force failed.
/// \throws std::exception with a message for the user when input or settings are bad, or no scan
/// could be integrated.
int run(const RunOptions& options);

/// `fiimap_eval parameters`: prints name, default, unit, allowed values, meaning and, of what may
/// change while the node runs, "tunable", of every parameter of map and node, separated by tabs.
void printParameters();

}  // namespace fiimap
