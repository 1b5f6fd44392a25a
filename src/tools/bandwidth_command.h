#pragma once

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval bandwidth`: what the clouds and ~changes of a recording's map take on a link.
struct BandwidthOptions {
  InputOptions input;
};

/// \return 0; 1 when the far end of ~changes had another map.
/// \throws std::exception with a message for the user when input or settings are bad, or no scan
/// could be integrated.
int measureBandwidth(const BandwidthOptions& options);

}  // namespace fiimap
