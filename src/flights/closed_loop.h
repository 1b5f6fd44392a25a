#pragma once

#include <cstddef>
#include <vector>

#include "flight.h"
#include "flight_record.h"
#include "flight_settings.h"

namespace fiimap {

/// How often a flight's clearance is noted, Hz.
constexpr double kClearanceRate = 10.0;

/// CPU time that each part of a flight took, s.
struct CpuTimes {
  double simulation = 0.0;  ///< vehicle, images, odometry and true clearance
  double mapping = 0.0;     ///< from images to snapshots
  double planning = 0.0;    ///< from snapshots to commands
};

/// How a flight ended, and what happened on the way.
struct FlightOutcome {
  bool reached = false;
  double seconds = 0.0;  ///< simulated, from the start
  sim::FlightRecord truth;
  FlightStatus planner;
  std::vector<double> clearances_m;  ///< true ones, kClearanceRate times a second
  std::vector<double> update_ms;     ///< wall-clock time of each update of the map
  std::vector<double> planning_ms;   ///< likewise of each step of the planner that planned
  CpuTimes cpu_s;
};

/// Flies from the start of a world to its goal: simulator, map and planner in one thread, in steps
/// of simulated time. The same settings give the same flight. Planning and mapping take no
/// simulated time.
/// \throws std::invalid_argument when the settings are not valid.
FlightOutcome flyClosedLoop(const FlightSettings& settings);

}  // namespace fiimap
