#include "periodic_thread.h"

#include <algorithm>
#include <utility>

namespace fiimap {

PeriodicThread::PeriodicThread(double period, std::function<void()> function)
    : period_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period))),
      function_(std::move(function)),
      thread_([this] { run(); }) {}

void PeriodicThread::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PeriodicThread::run() {
  Clock::time_point next = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    function_();
    lock.lock();
    // Calls that could not be made in time are left out.
    next = std::max(next + period_, Clock::now());
    stopped_.wait_until(lock, next, [this] { return stopping_; });
  }
}

}  // namespace fiimap
