#pragma once

#include <fiimap/MapChanges.h>

#include <cstdint>
#include <memory>

#include "fiimap/change_set.h"
#include "fiimap/inflater.h"
#include "fiimap/mapper_config.h"
#include "fiimap/sliding_grid.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// Makes the map anew from the messages on ~changes, at the other end of a link. Trusts no message:
/// what does not fit is refused, and a memory limit bounds the map. Not thread-safe; the snapshots
/// are.
class MapChangesReader {
 public:
  /// What a message brought.
  enum class Result {
    kMap,      ///< snapshot() is the map of the message
    kNoMap,    ///< the vehicle has no map
    kLost,     ///< messages are missing before this one; the next keyframe helps
    kWaiting,  ///< for a keyframe
  };

  /// \param memory_limit MB for the map when all of its window is seen; 0: the machine's memory.
  explicit MapChangesReader(double memory_limit) : memory_limit_(memory_limit) {}

  /// Applies the next message.
  /// \throws std::invalid_argument that names the field, its value and what is allowed, when the
  /// message is malformed; the map is forgotten until the next keyframe.
  Result read(const MapChanges& message);

  /// The map of the newest message, null where there is none. Its occupied and inflated voxels are
  /// those of the map that the messages are of; of the others it is not told which are known.
  std::shared_ptr<const Snapshot> snapshot() const { return snapshot_; }

 private:
  void startAnew(const MapperConfig& config, const VoxelBox& window);
  void apply(const MapChanges& message, const VoxelBox& window);
  void flip(std::int64_t first, std::int64_t count, ChangeSet* changes);
  void setInflation(const MapperConfig& config);

  double memory_limit_;
  std::shared_ptr<const Snapshot> snapshot_;  // null: what follows holds no map
  MapperConfig config_;
  std::unique_ptr<SlidingGrid> grid_;
  std::unique_ptr<Inflater> inflater_;
};

}  // namespace fiimap
