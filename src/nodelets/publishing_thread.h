#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace fiimap {

/// Calls a function in a thread of its own soon after it was woken, at most at a given rate.
/// Several wakes before a call are one. Thread-safe.
class PublishingThread {
 public:
  /// \param rate Hz; \param publish must not throw.
  PublishingThread(double rate, std::function<void()> publish);
  ~PublishingThread() { stop(); }

  void wake();
  void setRate(double rate);
  /// The function is not running any more when this returns, nor called again.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::duration periodOf(double rate);
  void run();

  Clock::duration period_;
  std::function<void()> publish_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fiimap
