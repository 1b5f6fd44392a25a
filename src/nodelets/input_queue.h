#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace fiimap {

/// Work on its way from the callbacks to the mapping thread, in order of arrival. Bounded: when the
/// mapping thread falls behind, the oldest scans of a sensor, or the oldest other data, give way to
/// newer ones. Control tasks never do. Thread-safe.
class InputQueue {
 public:
  using Task = std::function<void()>;

  struct Batch {
    std::vector<Task> tasks;
    std::vector<std::size_t> displaced_scans;  ///< by sensor, that gave way since the last batch
    std::size_t displaced_others = 0;
  };

  static constexpr std::size_t kMaxOthers = 10000;

  /// \param max_scans of each sensor.
  explicit InputQueue(std::size_t max_scans, std::size_t sensors = 1);

  /// After close(), tasks are destroyed instead of queued.
  void pushScan(Task task, std::size_t sensor = 0) { push(std::move(task), sensor); }
  /// Poses, transforms, camera infos.
  void pushOther(Task task) { push(std::move(task), sensors_); }
  void pushControl(Task task) { push(std::move(task), sensors_ + 1); }

  /// Takes all tasks; waits for one at most as long as given. Empty after close().
  Batch take(std::chrono::milliseconds wait);

  /// Destroys all tasks and wakes the mapping thread.
  void close();

 private:
  /// What tasks are about: the number of a sensor, then other data, then control.
  using Kind = std::size_t;
  struct Bound {
    std::size_t max = 0, count = 0, displaced = 0;
  };

  struct Entry {
    Task task;
    Kind kind;
  };

  void push(Task task, Kind kind);

  const std::size_t sensors_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> entries_;
  std::vector<Bound> bounds_;  // by kind, without control
  bool closed_ = false;
};

}  // namespace fiimap
