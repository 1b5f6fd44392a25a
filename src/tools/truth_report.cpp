#include "truth_report.h"

#include <cmath>
#include <cstdio>

namespace fiimap {
namespace {

/// A voxel is a leftover when something passed over its middle, and now all is a voxel away.
constexpr double kPassedWithin = 0.5;  // voxel edges
constexpr double kNowBeyond = 1.0;     // voxel edges

bool isOccupiedBeside(const Snapshot& map, const VoxelIndex& v) {
  if (map.occupancy(v) == Occupancy::kOccupied) return true;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      VoxelIndex neighbour = v;
      neighbour[axis] += step;
      if (map.occupancy(neighbour) == Occupancy::kOccupied) return true;
    }
  }
  return false;
}

void compareVoxel(const Eigen::Vector3d& center_W, double resolution, const ExactScene& scene,
                  double time, TruthCount* count) {
  const double distance = scene.signedDistance(center_W, time);
  if (scene.distanceToPassing(center_W) >= SeenSurface::kPassingMargin) {
    ++count->occupied;
    const double half_diagonal = resolution * std::sqrt(3.0) / 2.0;
    if (std::abs(distance) > half_diagonal) ++count->off;
    return;
  }
  const bool passed = scene.distanceToPassing(center_W, time) < kPassedWithin * resolution;
  if (passed && distance > kNowBeyond * resolution) ++count->leftover;
}

}  // namespace

void compareWithScene(const Snapshot& map, const ExactScene& scene, const SeenSurface& surface,
                      const VoxelBox& box, double time, TruthCount* count) {
  ++count->snapshots;
  const VoxelBox inside = box.intersection(map.window());
  for (const VoxelIndex& v : map.voxels(Plane::kOccupied, inside)) {
    compareVoxel(map.lattice().centerOf(v), map.lattice().resolution(), scene, time, count);
  }
  surface.forEach([&](const Eigen::Vector3d& point_W, int scans) {
    const VoxelIndex v = map.lattice().indexOf(point_W);
    if (!inside.contains(v)) return;
    const bool found = isOccupiedBeside(map, v);
    ++count->seen;
    if (found) ++count->seen_found;
    if (scans < TruthCount::kOften) return;
    ++count->often;
    if (found) ++count->often_found;
  });
}

nlohmann::json toJson(const TruthRow& row) {
  const FreeSpaceCount& space = row.free_space;
  return {
      {"resolution", row.resolution},
      {"snapshots", row.count.snapshots},
      {"half", row.count.half()},
      {"recall_5", row.count.recallOften()},
      {"recall_any", row.count.recallAny()},
      {"dyn", row.count.leftover},
      {"occupied", row.count.occupied},
      {"cells_5", row.count.often},
      {"cells_any", row.count.seen},
      {"free_recall", space.free == 0 ? 0.0 : static_cast<double>(space.found) / space.free},
      {"free_but_occupied",
       space.free == 0 ? 0.0 : static_cast<double>(space.occupied) / space.free},
      {"free_voxels", space.free},
      {"inflation", row.inflation.json()},
      {"obstacles", row.obstacles},
  };
}

std::string toText(const std::vector<TruthRow>& rows, bool csv) {
  std::string text =
      csv ? "resolution,snapshots,half,recall_5,recall_any,dyn,free_recall,missing_share,"
            "least_clearance_m,excess_share\n"
          : "resolution  snapshots    half  recall>=5     any    dyn    free  missing  clearance"
            "  excess\n";
  const char* format =
      csv ? "%g,%zu,%.6f,%.6f,%.6f,%zu,%.6f,%.6f,%.6f,%.6f\n"
          : "%8g m %10zu  %.4f     %.4f  %.4f %6zu  %.4f   %.4f   %6.3f m   %.4f\n";
  for (const TruthRow& row : rows) {
    const nlohmann::json json = toJson(row);
    const nlohmann::json& inflation = json["inflation"];
    char line[192];
    std::snprintf(line, sizeof(line), format, row.resolution, row.count.snapshots, row.count.half(),
                  row.count.recallOften(), row.count.recallAny(), row.count.leftover,
                  json["free_recall"].get<double>(), inflation["missing_share"].get<double>(),
                  inflation["least_clearance_m"].get<double>(),
                  inflation["excess_share"].get<double>());
    text += line;
  }
  return text;
}

}  // namespace fiimap
