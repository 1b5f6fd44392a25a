#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>

#include "fiimap/snapshot.h"

namespace fiimap {

/// Where readers in other threads get the newest snapshot. A reader never waits for the mapper, nor
/// the mapper for a reader: the newest snapshot sits in one of a few slots, and the mapper only
/// writes a slot that is neither the current one nor being read.
/// latest() may be called from any number of threads, publish() from one at a time.
class MapHandle {
 public:
  /// \param id unique name of the map in the process: the mapping nodelet's full name.
  explicit MapHandle(const std::string& id) : id_(id) {}

  /// As given to the constructor.
  const std::string& id() const { return id_; }

  /// The newest snapshot; null before the first scan and after a reset until the next scan.
  std::shared_ptr<const Snapshot> latest() const;

  /// Makes a snapshot (or null) the newest one.
  void publish(std::shared_ptr<const Snapshot> snapshot);

 private:
  /// Readers hold a slot only while they copy its pointer, so all but a few are free at any time.
  static constexpr int kSlots = 16;

  struct Slot {
    std::atomic<int> readers{0};
    std::shared_ptr<const Snapshot> snapshot;
  };

  std::string id_;
  mutable std::array<Slot, kSlots> slots_;
  std::atomic<int> current_{0};
};

/// Finds map handles of this process by id, for planners that start after the map. Holds no handle
/// alive. Thread-safe.
class MapRegistry {
 public:
  /// The handle, or null when no such map lives.
  static std::shared_ptr<const MapHandle> find(const std::string& id);
  /// Registers a handle under its id for as long as it lives.
  static void add(const std::shared_ptr<const MapHandle>& handle);
};

}  // namespace fiimap
