#pragma once

#include <string>

#include "fiimap/mapper_config.h"
#include "planner_config.h"
#include "simulator_config.h"

namespace fiimap {

/// Everything that decides a closed-loop flight.
struct FlightSettings {
  sim::SimulatorConfig simulator;
  MapperConfig map;
  PlannerParameters planner;
  double time_limit = 300.0;  ///< s
};

/// Sets what a file of parameters says (YAML, as for the nodes).
/// \param part simulator, map or planner.
/// \throws std::invalid_argument that says what is wrong.
void applyFile(const std::string& part, const std::string& file, FlightSettings* settings);

/// Sets one parameter.
/// \param setting PART.NAME=VALUE, for instance planner.max_speed=3.
/// \throws std::invalid_argument that says what is wrong.
void applySetting(const std::string& setting, FlightSettings* settings);

/// \throws std::invalid_argument that names the parameter, its value and what is allowed.
void validate(const FlightSettings& settings);

}  // namespace fiimap
