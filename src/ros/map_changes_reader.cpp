#include "fiimap/ros/map_changes_reader.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fiimap/MapInfo.h>

#include "length_stream.h"

namespace fiimap {
namespace {

/// Farther from the origin no window of a map can lie: 2^30 voxels for the vehicle, and the window.
constexpr std::int64_t kFarthestVoxel = (std::int64_t{1} << 30) + (std::int64_t{1} << 20);
/// Inflation takes so many changes at once: bounds the memory for a message.
constexpr std::size_t kMostChangesAtOnce = std::size_t{1} << 16;

template <typename... Words>
[[noreturn]] void refuseMessage(const Words&... words) {
  std::ostringstream text;
  text << "fiimap/MapChanges refused: ";
  (text << ... << words);
  throw std::invalid_argument(text.str());
}

VoxelBox windowOf(const MapChanges& message) {
  VoxelBox window;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t min = message.window_min[axis], max = message.window_max[axis];
    if (std::abs(min) > kFarthestVoxel || std::abs(max) > kFarthestVoxel || min >= max) {
      refuseMessage("window_min[", axis, "] = ", min, ", window_max[", axis, "] = ", max,
                    ": must be ascending and at most ", kFarthestVoxel, " voxels from 0");
    }
    window.min[axis] = message.window_min[axis];
    window.max[axis] = message.window_max[axis];
  }
  return window;
}

/// An extent, m, that a window of so many voxels may have been configured with: one is rounded to
/// voxels, and the longest of all to a window that is longer.
double extentOf(int voxels, double resolution) {
  constexpr double kRounding = 0.49;
  return (voxels > 1 ? voxels - kRounding : voxels) * resolution;
}

/// The configuration of a map as the message says.
/// \throws std::invalid_argument when no map can have it.
MapperConfig configOf(const MapChanges& message, const VoxelIndex& size, double memory_limit) {
  if (message.inflation_shape > MapInfo::SHAPE_DIAMOND) {
    refuseMessage("inflation_shape = ", int{message.inflation_shape},
                  ": must be one of MapInfo's SHAPE_*");
  }
  MapperConfig config;
  config.resolution = message.resolution;
  config.map_size_x = extentOf(size.x(), message.resolution);
  config.map_size_y = extentOf(size.y(), message.resolution);
  config.map_size_z = extentOf(size.z(), message.resolution);
  config.slide_distance = 0.0;
  // No scan is integrated here, so none needs memory.
  config.local_update_range_x = config.local_update_range_y = config.local_update_range_z =
      message.resolution;
  config.memory_limit = memory_limit;
  config.inflation_radius = message.inflation_radius;
  config.inflation_shape = static_cast<ElementShape>(message.inflation_shape);
  try {
    config.validate();
  } catch (const std::invalid_argument& error) {
    refuseMessage("it is of a map that cannot be: ", error.what());
  }
  return config;
}

void requireSameGrid(const MapChanges& message, const Snapshot& before) {
  const VoxelIndex size = before.window().size();
  if (message.resolution != before.info().resolution || windowOf(message).size() != size) {
    refuseMessage("resolution and size of the window changed without a keyframe: must be ",
                  before.info().resolution, " m and ", size.x(), " x ", size.y(), " x ", size.z(),
                  " voxels");
  }
}

Snapshot::Info infoOf(const MapChanges& message) {
  Snapshot::Info info;
  info.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
  info.sequence = message.sequence;
  info.resolution = message.resolution;
  info.inflation_shape = static_cast<ElementShape>(message.inflation_shape);
  info.inflation_radius = message.inflation_radius;
  return info;
}

void requireCount(const char* name, std::uint64_t expected, std::int64_t found) {
  if (expected == static_cast<std::uint64_t>(found)) return;
  refuseMessage(name, " = ", expected, " voxels, but with its changes there are ", found);
}

/// \param left voxels of the window after those that were told of.
/// \return false when there is no more.
bool readLength(const char* what, std::int64_t left, LengthReader* lengths, std::int64_t* length) {
  std::uint64_t number = 0;
  try {
    if (!lengths->next(&number)) return false;
  } catch (const std::invalid_argument& error) {
    refuseMessage("changes: ", error.what());
  }
  if (number > static_cast<std::uint64_t>(left)) {
    refuseMessage("changes: ", number, " voxels that ", what, ", must be at most ", left,
                  ", which are left of the window");
  }
  *length = static_cast<std::int64_t>(number);
  return true;
}

}  // namespace

MapChangesReader::Result MapChangesReader::read(const MapChanges& message) {
  // What fails on its way leaves no half map.
  const std::shared_ptr<const Snapshot> before = std::move(snapshot_);
  snapshot_ = nullptr;
  if (message.sequence == 0) {
    if (message.previous != 0 || !message.changes.empty()) {
      refuseMessage("sequence = 0, no map, but previous = ", message.previous, " and ",
                    message.changes.size(), " bytes of changes: must be 0");
    }
    return Result::kNoMap;
  }
  const bool is_keyframe = message.previous == 0;
  if (!is_keyframe) {
    if (!before) return Result::kWaiting;
    if (before->info().sequence != message.previous) return Result::kLost;
    if (message.sequence <= message.previous) {
      refuseMessage("sequence = ", message.sequence,
                    ": must be above previous = ", message.previous);
    }
    requireSameGrid(message, *before);
  }
  const VoxelBox window = windowOf(message);
  const MapperConfig config = configOf(message, window.size(), memory_limit_);
  if (is_keyframe) startAnew(config, window);
  apply(message, window);
  setInflation(config);
  requireCount("occupied", message.occupied, grid_->count(Plane::kOccupied));
  requireCount("inflated", message.inflated, grid_->count(Plane::kInflated));
  snapshot_ = std::make_shared<const Snapshot>(grid_.get(), infoOf(message));
  return Result::kMap;
}

void MapChangesReader::startAnew(const MapperConfig& config, const VoxelBox& window) {
  grid_.reset();  // before there is another
  grid_ = std::make_unique<SlidingGrid>(window.size());
  ChangeSet of_an_empty_map;
  grid_->moveTo(window.min, &of_an_empty_map);
  inflater_ = makeInflater(config);
  config_ = config;
}

void MapChangesReader::apply(const MapChanges& message, const VoxelBox& window) {
  ChangeSet changes;
  grid_->moveTo(window.min, &changes);
  LengthReader lengths(message.changes);
  const std::int64_t voxels = window.volume();
  std::int64_t place = 0, same = 0, changed = 0;
  while (readLength("do not change", voxels - place, &lengths, &same)) {
    const std::int64_t first = place + same;
    if (!readLength("change", voxels - first, &lengths, &changed)) changed = 0;
    if (changed == 0 || (same == 0 && place > 0)) {
      refuseMessage("changes: ", same, " voxels that do not change before ", changed,
                    " that do, at place ", place,
                    ": only the first number may be 0, the last one is of voxels that change");
    }
    flip(first, changed, &changes);
    place = first + changed;
  }
  inflater_->update(changes, grid_.get());
}

/// \param first place in the row of voxels that MapChanges.msg describes.
void MapChangesReader::flip(std::int64_t first, std::int64_t count, ChangeSet* changes) {
  const VoxelIndex min = grid_->window().min, size = grid_->window().size();
  VoxelIndex v = min;
  v.x() += static_cast<int>(first / size.z() / size.y());
  v.y() += static_cast<int>(first / size.z() % size.y());
  v.z() += static_cast<int>(first % size.z());
  for (; count > 0; --count) {
    const bool was_occupied = grid_->test(Plane::kOccupied, v);
    grid_->set(Plane::kOccupied, v, !was_occupied);
    (was_occupied ? changes->raise : changes->lower).push_back(v);
    if (changes->score() == kMostChangesAtOnce) {
      inflater_->update(*changes, grid_.get());
      changes->clear();
    }
    if (++v.z() < min.z() + size.z()) continue;
    v.z() = min.z();
    if (++v.y() < min.y() + size.y()) continue;
    v.y() = min.y();
    ++v.x();
  }
}

void MapChangesReader::setInflation(const MapperConfig& config) {
  if (config.inflation_radius == config_.inflation_radius &&
      config.inflation_shape == config_.inflation_shape) {
    return;
  }
  inflater_ = makeInflater(config);
  rebuildInflation(inflater_.get(), grid_.get());
  config_ = config;
}

}  // namespace fiimap
