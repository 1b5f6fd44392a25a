#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace fiimap {

/// Calls a function again and again in a thread of its own, by the steady clock.
class PeriodicThread {
 public:
  /// \param period between the beginnings of calls, s; \param function must not throw.
  PeriodicThread(double period, std::function<void()> function);
  ~PeriodicThread() { stop(); }

  /// The function is not running any more when this returns, nor called again.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  Clock::duration period_;
  std::function<void()> function_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fiimap
