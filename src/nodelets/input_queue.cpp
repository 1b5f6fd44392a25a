#include "input_queue.h"

#include <algorithm>
#include <utility>

namespace fiimap {

void InputQueue::push(Task task, Kind kind) {
  // Destroyed after the lock is released, as it may hold the last reference to a message.
  Task displaced;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    if (kind != kControl && counts_[kind]++ == max_[kind]) {
      const auto oldest = std::find_if(entries_.begin(), entries_.end(),
                                       [kind](const Entry& e) { return e.kind == kind; });
      displaced.swap(oldest->task);
      entries_.erase(oldest);
      --counts_[kind];
      ++displaced_[kind];
    }
    entries_.push_back({std::move(task), kind});
  }
  changed_.notify_one();
}

InputQueue::Batch InputQueue::take(std::chrono::milliseconds wait) {
  Batch batch;
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, wait, [this] { return closed_ || !entries_.empty(); });
  batch.tasks.reserve(entries_.size());
  for (Entry& entry : entries_) batch.tasks.push_back(std::move(entry.task));
  entries_.clear();
  counts_ = {};
  batch.displaced_scans = displaced_[kScan];
  batch.displaced_others = displaced_[kOther];
  displaced_ = {};
  return batch;
}

void InputQueue::close() {
  std::deque<Entry> discarded;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    discarded.swap(entries_);
    counts_ = {};
  }
  changed_.notify_all();
}

}  // namespace fiimap
