#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <vector>

namespace fiimap {

/// Work on its way from the callbacks to the mapping thread, in order of arrival. Bounded: when the
/// mapping thread falls behind, the oldest scans give way to newer ones. Thread-safe.
class InputQueue {
 public:
  using Task = std::function<void()>;

  struct Batch {
    std::vector<Task> tasks;
    std::size_t displaced_scans = 0;  ///< scans that gave way since the last batch
  };

  explicit InputQueue(std::size_t max_scans) : max_scans_(max_scans) {}

  /// After close(), tasks are destroyed instead of queued.
  void push(Task task) { push({std::move(task), false}); }
  void pushScan(Task task) { push({std::move(task), true}); }

  /// Takes all tasks; waits for one at most as long as given. Empty after close().
  Batch take(std::chrono::milliseconds wait);

  /// Destroys all tasks and wakes the mapping thread.
  void close();

 private:
  struct Entry {
    Task task;
    bool is_scan;
  };

  void push(Entry entry);
  void dropOldest(bool scan);

  std::size_t max_scans_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> entries_;
  std::size_t scans_ = 0;
  std::size_t displaced_scans_ = 0;
  bool closed_ = false;
};

}  // namespace fiimap
