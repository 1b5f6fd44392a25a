#include "fiimap/ros/map_changes.h"

#include <cstdint>
#include <vector>

#include "fiimap/ros/map_messages.h"
#include "length_stream.h"

namespace fiimap {
namespace {

/// The runs of unchanged and changed voxels, in turns, as MapChanges.msg says.
std::vector<std::uint8_t> encode(const std::vector<VoxelRun>& runs, const VoxelBox& window) {
  LengthWriter lengths;
  const VoxelIndex size = window.size();
  std::int64_t first = 0, end = 0;  // of the run that is not written yet
  for (const VoxelRun& run : runs) {
    const VoxelIndex v = run.first - window.min;
    const std::int64_t place = (std::int64_t{v.x()} * size.y() + v.y()) * size.z() + v.z();
    const bool continues = place == end && end > first;  // from the top of the column before
    if (!continues) {
      if (end > first) lengths.add(static_cast<std::uint64_t>(end - first));
      lengths.add(static_cast<std::uint64_t>(place - end));
      first = place;
    }
    end = place + run.count;
  }
  if (end > first) lengths.add(static_cast<std::uint64_t>(end - first));
  return lengths.finish();
}

}  // namespace

MapChanges toMapChanges(const Snapshot& snapshot, const Snapshot* before,
                        const std::string& map_frame) {
  const Snapshot::Info& info = snapshot.info();
  MapChanges message;
  message.header = toHeader(snapshot, map_frame);
  message.sequence = info.sequence;
  message.previous = before == nullptr ? 0 : before->info().sequence;
  message.resolution = info.resolution;
  for (int axis = 0; axis < 3; ++axis) {
    message.window_min[axis] = info.window.min[axis];
    message.window_max[axis] = info.window.max[axis];
  }
  message.inflation_radius = info.inflation_radius;
  message.inflation_shape = static_cast<std::uint8_t>(info.inflation_shape);
  message.occupied = static_cast<std::uint64_t>(snapshot.count(Plane::kOccupied));
  message.inflated = static_cast<std::uint64_t>(snapshot.count(Plane::kInflated));
  message.changes = encode(snapshot.changes(Plane::kOccupied, before), info.window);
  return message;
}

MapChanges toEmptyKeyframe(const std_msgs::Header& header) {
  MapChanges message;
  message.header = header;
  return message;
}

}  // namespace fiimap
