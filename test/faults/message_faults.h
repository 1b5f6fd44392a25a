#pragma once

#include <functional>
#include <map>
#include <string>

#include "fault_rig.h"

namespace fiimap {

/// How a fault is made.
struct MessageFault {
  RigInputs inputs;
  std::function<void(FaultRig*)> make;
  bool at_start = false;  ///< before any good frame
  double clock = 5000.0;  ///< where the simulated clock begins, s
};

using MessageFaults = std::map<std::string, MessageFault>;

/// By the id of their row in faults.yaml.
const MessageFaults& messageFaults();

/// Parts of it.
MessageFaults imageFaults();
MessageFaults depthFaults();
MessageFaults cloudFaults();
MessageFaults poseFaults();
MessageFaults transformFaults();
MessageFaults timeFaults();

}  // namespace fiimap
