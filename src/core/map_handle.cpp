#include "fiimap/map_handle.h"

#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace fiimap {
namespace {

class Registry {
 public:
  static Registry& instance() {
    // Never destroyed: nodelets may be unloaded after static destructors have begun.
    static Registry* const registry = new Registry;
    return *registry;
  }

  std::shared_ptr<const MapHandle> find(const std::string& id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = handles_.find(id);
    return found == handles_.end() ? nullptr : found->second.lock();
  }

  void add(const std::shared_ptr<const MapHandle>& handle) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto it = handles_.begin(); it != handles_.end();) {
      it = it->second.expired() ? handles_.erase(it) : std::next(it);
    }
    handles_[handle->id()] = handle;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const MapHandle>> handles_;
};

}  // namespace

// Why this is safe (all atomics are sequentially consistent): publish() writes only a slot that is
// not current and has no readers. A reader that enters such a slot late sees, when it looks again,
// that the slot is not current, and leaves without touching the pointer. If it sees the slot
// current, the write is complete, and the slot is not written again until the reader has left.

std::shared_ptr<const Snapshot> MapHandle::latest() const {
  for (;;) {
    const int index = current_.load();
    Slot& slot = slots_[index];
    slot.readers.fetch_add(1);
    std::shared_ptr<const Snapshot> snapshot;
    const bool is_current = current_.load() == index;
    if (is_current) snapshot = slot.snapshot;
    slot.readers.fetch_sub(1);
    if (is_current) return snapshot;
  }
}

void MapHandle::publish(std::shared_ptr<const Snapshot> snapshot) {
  const int old = current_.load();
  int next = (old + 1) % kSlots;
  while (next == old || slots_[next].readers.load() != 0) {
    next = (next + 1) % kSlots;
    // Only when more readers than slots were interrupted while copying a pointer.
    if (next == old) std::this_thread::yield();
  }
  slots_[next].snapshot = std::move(snapshot);
  current_.store(next);
  // The old snapshot's memory must not wait for the slot's next turn.
  if (slots_[old].readers.load() == 0) slots_[old].snapshot.reset();
}

std::shared_ptr<const MapHandle> MapRegistry::find(const std::string& id) {
  return Registry::instance().find(id);
}

void MapRegistry::add(const std::shared_ptr<const MapHandle>& handle) {
  Registry::instance().add(handle);
}

}  // namespace fiimap
