#include "fiimap/ros/map_queries.h"

#include <cstdint>
#include <optional>
#include <stdexcept>

#include "fiimap/ros/geometry_messages.h"
#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

// As the definitions of the services say.
constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 24;
constexpr std::int64_t kMaxPoints = std::int64_t{1} << 20;
constexpr const char* kBadPoint = "must be finite and less than 2^30 voxels from the origin";
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

/// As GetBox.srv and QueryPoints.srv say.
template <typename Place>
std::uint8_t toStates(const Snapshot& snapshot, const Place& place) {
  return static_cast<std::uint8_t>(toState(snapshot.occupancy(place)) +
                                   kInflatedFactor * toState(snapshot.inflation(place)));
}

[[noreturn]] void refuseQuery(const std::string& what) { throw std::invalid_argument(what); }

void requireAtMost(const std::string& what, double count, std::int64_t limit) {
  if (count <= static_cast<double>(limit)) return;
  refuseQuery(what + " must be at most " + std::to_string(limit) + "; ask for fewer at once");
}

/// Lets a function fill an answer, which tells why when it throws.
template <typename Response, typename Fill>
Response answer(const Snapshot& snapshot, const std::string& map_frame, Fill&& fill) {
  Response response;
  try {
    fill(&response);
    response.header = toHeader(snapshot, map_frame);
    response.success = true;
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
  }
  return response;
}

Unseen toUnseen(const std::string& name, std::uint8_t value) {
  if (value == CastRays::Request::OBSTACLE) return Unseen::kObstacle;
  if (value == CastRays::Request::FREE) return Unseen::kFree;
  refuseQuery(name + " = " + std::to_string(value) + ": must be OBSTACLE (1) or FREE (2)");
}

ObstacleRules toRules(const CastRays::Request& request) {
  ObstacleRules rules{};
  if (request.layer == CastRays::Request::INFLATED) {
    rules.layer = MapLayer::kInflated;
  } else if (request.layer == CastRays::Request::RAW) {
    rules.layer = MapLayer::kRaw;
  } else {
    refuseQuery("layer = " + std::to_string(request.layer) + ": must be INFLATED (1) or RAW (2)");
  }
  rules.unknown = toUnseen("unknown", request.unknown);
  rules.outside = toUnseen("outside", request.outside);
  return rules;
}

void requireAllowed(const CastRays::Request& request, const VoxelLattice& lattice) {
  if (request.starts.size() != request.ends.size()) {
    refuseQuery("starts has " + std::to_string(request.starts.size()) + " points, ends has " +
                std::to_string(request.ends.size()) + ": must be as many");
  }
  requireAtMost("segments", static_cast<double>(request.starts.size()), kMaxPoints);
  double voxels = 0.0;
  for (std::size_t i = 0; i < request.starts.size(); ++i) {
    const Eigen::Vector3d from = toEigen(request.starts[i]), to = toEigen(request.ends[i]);
    if (!lattice.canIndex(from) || !lattice.canIndex(to)) {
      refuseQuery("segment " + std::to_string(i) + ": " + kBadPoint);
    }
    voxels += lattice.toVoxels(to - from).lpNorm<1>();
  }
  requireAtMost("voxels along all segments", voxels, kMaxVoxels);
}

}  // namespace

VoxelBox toVoxelBox(const VoxelLattice& lattice, const geometry_msgs::Point& min,
                    const geometry_msgs::Point& max) {
  const Eigen::Vector3d low = toEigen(min), high = toEigen(max);
  if (!lattice.canIndex(low) || !lattice.canIndex(high)) {
    refuseQuery(std::string("min and max: ") + kBadPoint);
  }
  if ((high.array() < low.array()).any())
    refuseQuery("max must not be less than min along any axis");
  return {lattice.indexOf(low), lattice.indexOf(high).array() + 1};
}

GetBox::Response queryBox(const Snapshot& snapshot, const GetBox::Request& request,
                          const std::string& map_frame) {
  return answer<GetBox::Response>(snapshot, map_frame, [&](GetBox::Response* response) {
    const VoxelBox box = toVoxelBox(snapshot.lattice(), request.min, request.max);
    // The size of a box from one end of all indices to the other is no index.
    requireAtMost("voxels of the box", (box.max.cast<double>() - box.min.cast<double>()).prod(),
                  kMaxVoxels);
    const VoxelIndex size = box.size();
    response->resolution = snapshot.info().resolution;
    response->origin = toPoint(box.min.cast<double>() * response->resolution);
    response->size_x = static_cast<std::uint32_t>(size.x());
    response->size_y = static_cast<std::uint32_t>(size.y());
    response->size_z = static_cast<std::uint32_t>(size.z());
    response->voxels.reserve(static_cast<std::size_t>(box.volume()));
    VoxelIndex v;
    for (v.x() = box.min.x(); v.x() < box.max.x(); ++v.x()) {
      for (v.y() = box.min.y(); v.y() < box.max.y(); ++v.y()) {
        for (v.z() = box.min.z(); v.z() < box.max.z(); ++v.z()) {
          response->voxels.push_back(toStates(snapshot, v));
        }
      }
    }
  });
}

QueryPoints::Response queryPoints(const Snapshot& snapshot, const QueryPoints::Request& request,
                                  const std::string& map_frame) {
  return answer<QueryPoints::Response>(snapshot, map_frame, [&](QueryPoints::Response* response) {
    requireAtMost("points", static_cast<double>(request.points.size()), kMaxPoints);
    response->states.reserve(request.points.size());
    for (const geometry_msgs::Point& point : request.points) {
      response->states.push_back(toStates(snapshot, toEigen(point)));
    }
  });
}

CastRays::Response castRays(const Snapshot& snapshot, const CastRays::Request& request,
                            const std::string& map_frame) {
  return answer<CastRays::Response>(snapshot, map_frame, [&](CastRays::Response* response) {
    const ObstacleRules rules = toRules(request);
    requireAllowed(request, snapshot.lattice());
    for (std::size_t i = 0; i < request.starts.size(); ++i) {
      const Eigen::Vector3d from = toEigen(request.starts[i]), to = toEigen(request.ends[i]);
      const std::optional<RayHit> hit = snapshot.castRay(from, to, rules);
      response->hit.push_back(hit.has_value());
      response->points.push_back(toPoint(hit ? hit->point_W : to));
      response->distances.push_back(hit ? hit->distance : (to - from).norm());
    }
  });
}

}  // namespace fiimap
