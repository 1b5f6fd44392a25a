#include <cstddef>

#include "doctor/checks.h"
#include "fiimap/ros/drop_reason.h"

namespace fiimap {
namespace {

constexpr double kManyLost = 0.1;  // of the scans

}  // namespace

// What the other checks did not foresee, the node's own synchronisation shows.
void checkTrial(const Trial& trial, Examination* e) {
  const std::size_t decided = trial.decided();
  if (decided == 0) {
    if (trial.scans > 0 && e->setup.has_poses) {
      e->error("Of " + std::to_string(trial.scans) +
                   " scans none found a pose: each still waits for one of its time.",
               "Look for longer with --seconds.");
    }
    return;
  }
  const std::size_t lost = decided - trial.usable;
  const std::string what = std::to_string(lost) + " of " + std::to_string(decided) +
                           " scans would be dropped, the last for " + trial.last_drop.detail;
  const std::string remedy = remedyFor(trial.last_drop.reason) + ".";
  if (trial.usable == 0) {
    e->error("No scan would go into the map: " + what + ".", remedy);
  } else if (static_cast<double>(lost) > kManyLost * static_cast<double>(decided)) {
    e->warn(what + ".", remedy);
  }
}

}  // namespace fiimap
