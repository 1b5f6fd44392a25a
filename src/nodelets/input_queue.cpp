#include "input_queue.h"

#include <algorithm>
#include <utility>

namespace fiimap {
namespace {

constexpr std::size_t kMaxOthers = 10000;  // poses, transforms, camera infos

}  // namespace

void InputQueue::push(Entry entry) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    if (entry.is_scan && scans_ == max_scans_) {
      dropOldest(true);
      ++displaced_scans_;
    } else if (!entry.is_scan && entries_.size() - scans_ == kMaxOthers) {
      dropOldest(false);
    }
    scans_ += entry.is_scan ? 1 : 0;
    entries_.push_back(std::move(entry));
  }
  changed_.notify_one();
}

void InputQueue::dropOldest(bool scan) {
  const auto oldest = std::find_if(entries_.begin(), entries_.end(),
                                   [scan](const Entry& e) { return e.is_scan == scan; });
  entries_.erase(oldest);
  scans_ -= scan ? 1 : 0;
}

InputQueue::Batch InputQueue::take(std::chrono::milliseconds wait) {
  Batch batch;
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, wait, [this] { return closed_ || !entries_.empty(); });
  batch.tasks.reserve(entries_.size());
  for (Entry& entry : entries_) batch.tasks.push_back(std::move(entry.task));
  entries_.clear();
  scans_ = 0;
  std::swap(batch.displaced_scans, displaced_scans_);
  return batch;
}

void InputQueue::close() {
  std::deque<Entry> discarded;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    discarded.swap(entries_);
    scans_ = 0;
  }
  changed_.notify_all();
}

}  // namespace fiimap
