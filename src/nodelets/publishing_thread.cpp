#include "publishing_thread.h"

#include <utility>

namespace fiimap {

PublishingThread::PublishingThread(double rate, std::function<void()> publish)
    : period_(periodOf(rate)), publish_(std::move(publish)), thread_([this] { run(); }) {}

void PublishingThread::wake() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void PublishingThread::setRate(double rate) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    period_ = periodOf(rate);
  }
  changed_.notify_all();
}

PublishingThread::Clock::duration PublishingThread::periodOf(double rate) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate));
}

void PublishingThread::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PublishingThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    changed_.wait(lock, [this] { return woken_ || stopping_; });
    if (stopping_) return;
    woken_ = false;
    const Clock::time_point start = Clock::now();
    lock.unlock();
    publish_();
    lock.lock();
    // The period may change while it passes.
    while (!stopping_ && Clock::now() < start + period_) {
      changed_.wait_until(lock, start + period_);
    }
  }
}

}  // namespace fiimap
