#include "pacer.h"

#include <algorithm>

namespace fiimap::sim {
namespace {

// A follower that is silent for so long has stopped, and nobody waits for it.
constexpr std::chrono::seconds kPatience{2};
// As much lost time is always made good: a thread is rarely woken at the very moment.
constexpr std::chrono::milliseconds kAlwaysCaughtUp{100};

}  // namespace

Pacer::Pacer(double real_time_factor, double max_lead, bool catches_up)
    : real_time_factor_(real_time_factor), max_lead_(max_lead), catches_up_(catches_up) {}

void Pacer::hear(Follower follower, double time) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_[static_cast<std::size_t>(follower)] = Progress{time, Clock::now()};
  }
  changed_.notify_all();
}

void Pacer::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void Pacer::waitFor(double time) {
  if (!start_) start_ = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ && isAhead(time)) changed_.wait_for(lock, kPatience);
  if (real_time_factor_ == 0.0) return;
  const Clock::time_point due = dueTime(time);
  changed_.wait_until(lock, due, [this] { return stopping_; });
  const Clock::duration late = std::max(Clock::now() - due, Clock::duration::zero());
  delay_ = std::chrono::duration<double>(late).count();
  if (!catches_up_ && late > kAlwaysCaughtUp) *start_ += late - kAlwaysCaughtUp;
}

/// Whether a follower that is still at work is too far behind.
bool Pacer::isAhead(double time) const {
  if (max_lead_ == 0.0) return false;
  const Clock::time_point now = Clock::now();
  return std::any_of(progress_.begin(), progress_.end(), [&](const auto& progress) {
    return progress && time - progress->time > max_lead_ && now - progress->heard < kPatience;
  });
}

Pacer::Clock::time_point Pacer::dueTime(double time) const {
  return *start_ + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(time / real_time_factor_));
}

}  // namespace fiimap::sim
