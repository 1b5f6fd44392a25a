#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "fiimap/ros/drop_reason.h"

namespace fiimap {

struct MapSetup;
struct Observation;

/// What the node would do with the messages that were seen, set up as the launch line does.
struct Trial {
  std::size_t scans = 0;   ///< seen
  std::size_t usable = 0;  ///< of them, those that found pose, place and intrinsics
  std::map<DropReason, std::size_t> dropped;
  Drop last_drop;
  std::vector<std::string> warnings;  ///< of the node

  /// Scans that found all or were dropped; the others wait for what comes later.
  std::size_t decided() const;
};

/// Runs the node's own synchronisation on the messages in the order of their arrival.
/// \return one trial for each of setup.allSensors(); warnings, which name no sensor, are the
/// first's.
std::vector<Trial> tryOut(const Observation& observation, const MapSetup& setup);

/// Of all sensors.
Trial sumOf(const std::vector<Trial>& trials);

}  // namespace fiimap
