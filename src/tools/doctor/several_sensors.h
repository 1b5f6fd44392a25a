#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"

namespace fiimap {

/// choose_sensors.cpp: several sensors that the user named by their topics, or a map that runs by
/// its parameter `sensors`.
/// \return false where neither did.
/// \throws std::invalid_argument when the user named more topics than there are sensors.
bool chooseNamedSensors(Examination* examination);
/// choose_sensors.cpp: every device beside the one that was chosen first.
/// \return false where there is only that one; nothing has changed then.
bool chooseAllSensors(Examination* examination);

/// What the map that runs listens to for one of its sensors; empty topics where that is unknown.
ListenedTopics listenedBy(const SensorConfig& sensor, const Observation& observation);

/// check_sensors.cpp: whether an error was found that no launch line takes care of.
bool isBlocked(const std::vector<Finding>& findings);

}  // namespace fiimap
