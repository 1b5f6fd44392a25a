#pragma once

#include <array>
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
/// mapping thread falls behind, the oldest scans, or the oldest other data, give way to newer ones.
/// Control tasks never do. Thread-safe.
class InputQueue {
 public:
  using Task = std::function<void()>;

  struct Batch {
    std::vector<Task> tasks;
    std::size_t displaced_scans = 0;  ///< that gave way since the last batch
    std::size_t displaced_others = 0;
  };

  static constexpr std::size_t kMaxOthers = 10000;

  explicit InputQueue(std::size_t max_scans) : max_{max_scans, kMaxOthers} {}

  /// After close(), tasks are destroyed instead of queued.
  void pushScan(Task task) { push(std::move(task), kScan); }
  /// Poses, transforms, camera infos.
  void pushOther(Task task) { push(std::move(task), kOther); }
  void pushControl(Task task) { push(std::move(task), kControl); }

  /// Takes all tasks; waits for one at most as long as given. Empty after close().
  Batch take(std::chrono::milliseconds wait);

  /// Destroys all tasks and wakes the mapping thread.
  void close();

 private:
  enum Kind { kScan, kOther, kControl };
  static constexpr std::size_t kBoundedKinds = kControl;

  struct Entry {
    Task task;
    Kind kind;
  };

  void push(Task task, Kind kind);

  std::array<std::size_t, kBoundedKinds> max_;  // by kind, as all that follow
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> entries_;
  std::array<std::size_t, kBoundedKinds> counts_{};
  std::array<std::size_t, kBoundedKinds> displaced_{};
  bool closed_ = false;
};

}  // namespace fiimap
