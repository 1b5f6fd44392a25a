#include "input_queue.h"

#include <algorithm>
#include <utility>

namespace fiimap {

InputQueue::InputQueue(std::size_t max_scans, std::size_t sensors)
    : sensors_(sensors), bounds_(sensors, Bound{max_scans}) {
  bounds_.push_back(Bound{kMaxOthers});
}

void InputQueue::push(Task task, Kind kind) {
  // Destroyed after the lock is released, as it may hold the last reference to a message.
  Task displaced;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    if (kind < bounds_.size() && bounds_[kind].count++ == bounds_[kind].max) {
      const auto oldest = std::find_if(entries_.begin(), entries_.end(),
                                       [kind](const Entry& e) { return e.kind == kind; });
      displaced.swap(oldest->task);
      entries_.erase(oldest);
      --bounds_[kind].count;
      ++bounds_[kind].displaced;
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
  for (Bound& bound : bounds_) {
    bound.count = 0;
    batch.displaced_scans.push_back(std::exchange(bound.displaced, 0));
  }
  batch.displaced_others = batch.displaced_scans.back();
  batch.displaced_scans.pop_back();
  return batch;
}

void InputQueue::close() {
  std::deque<Entry> discarded;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    discarded.swap(entries_);
    for (Bound& bound : bounds_) bound.count = 0;
  }
  changed_.notify_all();
}

}  // namespace fiimap
