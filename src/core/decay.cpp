#include "fiimap/decay.h"

#include <algorithm>
#include <cmath>

namespace fiimap {
namespace {

constexpr double kNanoseconds = 1e9;  // in a second

}  // namespace

void Decay::setTime(double time) {
  time_ns_ = std::llround(time * kNanoseconds);
  elapsed_ns_ = 0;
  visited_ = 0;
}

void Decay::advance(std::int64_t stamp_ns, SlidingGrid* grid, ChangeSet* changes) {
  if (newest_ns_ && stamp_ns <= *newest_ns_) return;
  // Unsigned, because stamps far apart differ by more than the signed type holds.
  const std::uint64_t passed = static_cast<std::uint64_t>(stamp_ns) -
                               static_cast<std::uint64_t>(newest_ns_.value_or(stamp_ns));
  newest_ns_ = stamp_ns;
  if (time_ns_ == 0) return;

  elapsed_ns_ += std::min(passed, static_cast<std::uint64_t>(time_ns_));
  const int slots = grid->ring().slots();
  for (const int due = visitsUntil(elapsed_ns_, slots); visited_ < due; ++visited_) {
    grid->forgetUnseen(visited_ & (slots - 1), &changes->raise);
  }
  if (elapsed_ns_ < time_ns_) return;
  elapsed_ns_ -= time_ns_;
  visited_ -= slots;
}

/// Slots that must have been visited so long after a round began; may be in the round after it.
int Decay::visitsUntil(std::int64_t elapsed_ns, int slots) const {
  return static_cast<int>(static_cast<double>(elapsed_ns) / static_cast<double>(time_ns_) * slots);
}

void Decay::restart() {
  newest_ns_.reset();
  elapsed_ns_ = 0;
  visited_ = 0;
}

}  // namespace fiimap
