#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

namespace fiimap::sim {

/// Holds simulated time back: to a multiple of real time, and to what others have worked off.
/// Thread-safe.
class Pacer {
 public:
  /// Who may be waited for.
  enum class Follower { kCommands, kPlanner, kMap };

  /// \param real_time_factor simulated seconds per second; 0: as fast as possible.
  /// \param max_lead how far, s, time may be ahead of each follower that was heard of; 0: any.
  /// \param catches_up whether more than a moment of lost time is made good by going
  /// faster.
  Pacer(double real_time_factor, double max_lead, bool catches_up);

  /// A follower has come to a time, s.
  void hear(Follower follower, double time);

  /// Returns when simulated time may go on to `time`, s, or when stopped.
  void waitFor(double time);
  /// How late the newest waitFor() returned, s.
  double delay() const { return delay_; }

  /// No wait any more, now and later.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Progress {
    double time;  ///< s, simulated
    Clock::time_point heard;
  };

  bool isAhead(double time) const;
  Clock::time_point dueTime(double time) const;

  double real_time_factor_;
  double max_lead_;
  bool catches_up_;
  double delay_ = 0.0;  // of the simulating thread alone, like start_
  std::optional<Clock::time_point> start_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<std::optional<Progress>, 3> progress_;  ///< by Follower
  bool stopping_ = false;
};

}  // namespace fiimap::sim
