#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"

namespace fiimap {

/// What to type for a map of what was found: the words of a roslaunch command, not quoted.
std::vector<std::string> launchWords(const Observation& observation, const MapSetup& setup);

/// The words as a shell wants them, over several lines.
std::string shellCommand(const std::vector<std::string>& words);

}  // namespace fiimap
