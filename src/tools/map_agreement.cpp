#include "map_agreement.h"

#include <cstdio>

namespace fiimap {
namespace {

constexpr Occupancy kStates[] = {Occupancy::kUnknown, Occupancy::kFree, Occupancy::kOccupied};

double share(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(part) / all;
}

std::size_t& cell(MapAgreement* agreement, Occupancy ours, Occupancy theirs) {
  return agreement->voxels[static_cast<int>(ours)][static_cast<int>(theirs)];
}

template <typename Map>
bool isOccupiedWithinOneVoxel(const Map& map, const VoxelIndex& v) {
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const VoxelIndex neighbour = v + VoxelIndex(dx, dy, dz);
        if (map.occupancy(neighbour) == Occupancy::kOccupied) return true;
      }
    }
  }
  return false;
}

const char* nameOf(Occupancy state) {
  switch (state) {
    case Occupancy::kFree:
      return "free";
    case Occupancy::kOccupied:
      return "occupied";
    default:
      return "unknown";
  }
}

}  // namespace

std::size_t MapAgreement::ours(Occupancy state) const {
  std::size_t count = 0;
  for (const std::size_t voxels_of_theirs : voxels[static_cast<int>(state)]) {
    count += voxels_of_theirs;
  }
  return count;
}

std::size_t MapAgreement::theirs(Occupancy state) const {
  std::size_t count = 0;
  for (const auto& row : voxels) count += row[static_cast<int>(state)];
  return count;
}

double MapAgreement::overlap(Occupancy state) const {
  const std::size_t both = voxels[static_cast<int>(state)][static_cast<int>(state)];
  return share(both, ours(state) + theirs(state) - both);
}

MapAgreement compareWithOctomap(const Snapshot& ours, const bench::OctomapMap& theirs) {
  MapAgreement agreement;
  agreement.resolution = ours.lattice().resolution();
  for (const VoxelIndex& v : ours.voxels(Plane::kKnown, ours.window())) {
    ++cell(&agreement, ours.occupancy(v), theirs.occupancy(v));
  }
  for (const VoxelIndex& v : ours.voxels(Plane::kOccupied, ours.window())) {
    if (isOccupiedWithinOneVoxel(theirs, v)) ++agreement.ours_found;
  }
  theirs.forEachKnown([&](const VoxelIndex& v, Occupancy state) {
    const Occupancy our_state = ours.occupancy(v);
    if (our_state == Occupancy::kUnknown) ++cell(&agreement, our_state, state);
    if (our_state == Occupancy::kOutside || state != Occupancy::kOccupied) return;
    if (isOccupiedWithinOneVoxel(ours, v)) ++agreement.theirs_found;
  });
  return agreement;
}

nlohmann::json toJson(const MapAgreement& agreement) {
  nlohmann::json json = {
      {"resolution", agreement.resolution},
      {"occupied_overlap", agreement.overlap(Occupancy::kOccupied)},
      {"free_overlap", agreement.overlap(Occupancy::kFree)},
      {"ours_found", share(agreement.ours_found, agreement.ours(Occupancy::kOccupied))},
      {"theirs_found", share(agreement.theirs_found, agreement.theirs(Occupancy::kOccupied))},
  };
  for (const Occupancy ours : kStates) {
    for (const Occupancy theirs : kStates) {
      if (ours == Occupancy::kUnknown && theirs == Occupancy::kUnknown) continue;
      json["voxels"][nameOf(ours)][nameOf(theirs)] =
          agreement.voxels[static_cast<int>(ours)][static_cast<int>(theirs)];
    }
  }
  return json;
}

std::string toText(const std::vector<MapAgreement>& agreements) {
  std::string text;
  for (const MapAgreement& agreement : agreements) {
    const nlohmann::json json = toJson(agreement);
    char line[256];
    std::snprintf(line, sizeof(line),
                  "fiimap and OctoMap at %g m: overlap of free %.4f, of occupied %.4f; within one "
                  "voxel of an occupied one of the other: fiimap's %.4f, OctoMap's %.4f\n",
                  agreement.resolution, json["free_overlap"].get<double>(),
                  json["occupied_overlap"].get<double>(), json["ours_found"].get<double>(),
                  json["theirs_found"].get<double>());
    text += line;
  }
  return text;
}

}  // namespace fiimap
