#include "fiimap/ros/map_edits.h"

#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "fiimap/ros/geometry_messages.h"
#include "fiimap/ros/map_queries.h"

namespace fiimap {
namespace {

/// Files hold a resolution in decimal digits.
constexpr double kRounding = 1e-5;

std::int64_t volumeOf(const std::vector<VoxelBox>& boxes) {
  return std::accumulate(boxes.begin(), boxes.end(), std::int64_t{0},
                         [](std::int64_t sum, const VoxelBox& box) { return sum + box.volume(); });
}

Occupancy stateOf(const ClearBox::Request& request) {
  if (request.state == ClearBox::Request::UNKNOWN) return Occupancy::kUnknown;
  if (request.state == ClearBox::Request::FREE) return Occupancy::kFree;
  throw std::invalid_argument("state = " + std::to_string(request.state) +
                              ": must be UNKNOWN (0) or FREE (1)");
}

void requireSameResolution(const SavedMap& saved, double resolution) {
  if (std::abs(saved.resolution - resolution) <= kRounding * resolution) return;
  std::ostringstream text;
  text << saved.file << ": has a resolution of " << saved.resolution << " m, the map one of "
       << resolution << " m: must be the same";
  throw std::invalid_argument(text.str());
}

}  // namespace

ClearBox::Response clearBox(const ClearBox::Request& request, Mapper* mapper) {
  const VoxelLattice lattice(mapper->config().resolution);
  const VoxelBox box = toVoxelBox(lattice, request.min, request.max);
  const Occupancy state = stateOf(request);
  if (!mapper->hasWindow()) throw std::invalid_argument("there is no map yet");
  ClearBox::Response response;
  response.success = true;
  response.voxels = static_cast<std::uint64_t>(mapper->overwrite({box}, state));
  response.message = std::to_string(response.voxels) + " voxels are " +
                     (state == Occupancy::kFree ? "free" : "unknown");
  return response;
}

LoadMap::Response loadMap(const SavedMap& map, const LoadMap::Request& request, Mapper* mapper) {
  requireSameResolution(map, mapper->config().resolution);
  mapper->placeWindow(toEigen(request.vehicle));
  const std::int64_t free = mapper->overwrite(map.free, Occupancy::kFree);
  const std::int64_t occupied = mapper->overwrite(map.occupied, Occupancy::kOccupied);
  LoadMap::Response response;
  response.success = true;
  response.occupied = static_cast<std::uint64_t>(occupied);
  response.free = static_cast<std::uint64_t>(free);
  response.outside =
      static_cast<std::uint64_t>(volumeOf(map.free) + volumeOf(map.occupied) - free - occupied);
  response.message = "loaded " + std::to_string(occupied) + " occupied and " +
                     std::to_string(free) + " free voxels of " + map.file + "; " +
                     std::to_string(response.outside) + " lie outside of the window";
  return response;
}

}  // namespace fiimap
