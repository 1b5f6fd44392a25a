#include "ready_queue.h"

#include <algorithm>
#include <utility>

namespace fiimap {

bool ReadyQueue::push(SynchronizedScan scan) {
  std::deque<Waiting>& scans = lines_.at(scan.sensor).scans;
  scans.push_back({std::move(scan), ++pushes_});
  if (scans.size() <= max_) return false;
  scans.pop_front();
  overloaded_ = true;
  return true;
}

SynchronizedScan ReadyQueue::pop() {
  const auto rank = [this](const Line& line) {
    return overloaded_ ? line.last_turn : line.scans.front().number;
  };
  Line* next = nullptr;
  for (Line& line : lines_) {
    if (line.scans.empty()) continue;
    if (next == nullptr || rank(line) < rank(*next)) next = &line;
  }
  SynchronizedScan scan = std::move(next->scans.front().scan);
  next->scans.pop_front();
  next->last_turn = ++turns_;
  if (empty()) overloaded_ = false;
  return scan;
}

bool ReadyQueue::empty() const {
  return std::all_of(lines_.begin(), lines_.end(),
                     [](const Line& line) { return line.scans.empty(); });
}

}  // namespace fiimap
