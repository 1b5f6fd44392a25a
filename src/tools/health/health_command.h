#pragma once

#include "evaluation_input.h"

namespace fiimap {

/// `fiimap_eval health`: whether a recording is fit to be mapped: rates, gaps and delays of its
/// topics, what its readings are, how its poses fit the scans.
struct HealthOptions {
  InputOptions input;
};

/// \return 0. \throws std::exception with a message for the user when input or settings are bad, or
/// no scan could be integrated.
int examineRecording(const HealthOptions& options);

}  // namespace fiimap
