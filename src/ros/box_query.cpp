#include "fiimap/ros/box_query.h"

#include <cstdint>
#include <sstream>

#include "fiimap/ros/geometry_messages.h"
#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 24;  // as GetBox.srv says
constexpr int kInflatedFactor = 4;

std::uint8_t toState(Occupancy occupancy) {
  switch (occupancy) {
    case Occupancy::kUnknown:
      return GetBox::Response::UNKNOWN;
    case Occupancy::kFree:
      return GetBox::Response::FREE;
    case Occupancy::kOccupied:
      return GetBox::Response::OCCUPIED;
    case Occupancy::kOutside:
      break;
  }
  return GetBox::Response::OUTSIDE;
}

std::uint8_t toState(Inflation inflation) {
  switch (inflation) {
    case Inflation::kUnknown:
      return GetBox::Response::UNKNOWN;
    case Inflation::kFree:
      return GetBox::Response::FREE;
    case Inflation::kInflated:
      return GetBox::Response::OCCUPIED;
    case Inflation::kOutside:
      break;
  }
  return GetBox::Response::OUTSIDE;
}

/// \return why the box between two corners cannot be had; empty: it can.
std::string refusal(const Snapshot& snapshot, const Eigen::Vector3d& min,
                    const Eigen::Vector3d& max) {
  std::ostringstream text;
  const VoxelLattice& lattice = snapshot.lattice();
  if (!lattice.canIndex(min) || !lattice.canIndex(max)) {
    text << "min and max must be finite and less than 2^31 voxels from the origin";
  } else if ((max.array() < min.array()).any()) {
    text << "max must not be less than min along any axis";
  } else if (((max - min).array() / snapshot.info().resolution + 1.0).prod() >
             static_cast<double>(kMaxVoxels)) {
    text << "the box must have at most " << kMaxVoxels << " voxels; ask for smaller ones";
  }
  return text.str();
}

}  // namespace

GetBox::Response queryBox(const Snapshot& snapshot, const GetBox::Request& request,
                          const std::string& map_frame) {
  const Eigen::Vector3d min(request.min.x, request.min.y, request.min.z);
  const Eigen::Vector3d max(request.max.x, request.max.y, request.max.z);
  GetBox::Response response;
  response.message = refusal(snapshot, min, max);
  response.success = response.message.empty();
  if (!response.success) return response;

  const VoxelLattice& lattice = snapshot.lattice();
  const VoxelBox box{lattice.indexOf(min), lattice.indexOf(max).array() + 1};
  const VoxelIndex size = box.size();
  response.header = toHeader(snapshot, map_frame);
  response.resolution = snapshot.info().resolution;
  response.origin = toPoint(box.min.cast<double>() * response.resolution);
  response.size_x = static_cast<std::uint32_t>(size.x());
  response.size_y = static_cast<std::uint32_t>(size.y());
  response.size_z = static_cast<std::uint32_t>(size.z());
  response.voxels.reserve(static_cast<std::size_t>(box.volume()));
  VoxelIndex v;
  for (v.x() = box.min.x(); v.x() < box.max.x(); ++v.x()) {
    for (v.y() = box.min.y(); v.y() < box.max.y(); ++v.y()) {
      for (v.z() = box.min.z(); v.z() < box.max.z(); ++v.z()) {
        response.voxels.push_back(static_cast<std::uint8_t>(
            toState(snapshot.occupancy(v)) + kInflatedFactor * toState(snapshot.inflation(v))));
      }
    }
  }
  return response;
}

}  // namespace fiimap
