#pragma once

#include <string>
#include <vector>

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval accuracy`: cross-validation. Some scans are held out, the others build the map, and
/// the map has to foretell the held-out ones.
struct AccuracyOptions {
  InputOptions input;
  std::vector<double> resolutions;  ///< m; empty: that of the configuration
  std::string split;                ///< file that names the held-out scans; empty: folds
  int folds = 0;          ///< number of folds, each held out in turn; 0: the last one of 10 only
  int fold = -1;          ///< hold out this one only; -1: as `folds` says
  int held_out_step = 4;  ///< pixels
  bool octomap = false;   ///< the same with OctoMap, and how far the two maps agree
  bool csv = false;       ///< print the table as CSV
};

/// \return 0. \throws std::exception with a message for the user when input or settings are bad, or
/// no scan could be held out.
int evaluateAccuracy(const AccuracyOptions& options);

}  // namespace fiimap
