#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"

namespace fiimap {

/// What a launch line must set beside what has an argument of its own: what the checks changed or
/// the user chose; of several sensors, their names and what each has of its own; of a map that
/// runs, all that differs from the defaults.
ParameterMap furtherParameters(const Observation& observation, const MapSetup& setup);

/// Names of those of them that a map that runs has set as they are.
std::vector<std::string> keptParameters(const Observation& observation, const MapSetup& setup);

/// As YAML in one line, those of a sensor under its name: "{a: 1, front: {b: [1, 2]}}"; empty where
/// there is nothing to set.
std::string toYaml(const ParameterMap& parameters);

}  // namespace fiimap
