#include "truth/passing_obstacles.h"

#include <cmath>

#include "quantiles.h"

namespace fiimap {
namespace {

/// An obstacle counts as seen when this many rays meet it in one scan.
constexpr std::size_t kMinHits = 10;
/// It has appeared when this share of the points that a scan meets is occupied in the map.
constexpr double kAppearedShare = 0.5;
/// What is nearer than this to an obstacle is occupied by it; it has left when all is farther.
constexpr double kWithin = 0.5;  // voxel edges
constexpr double kLeftBeyond = 1.0;

bool isOccupiedNear(const Snapshot& map, const VoxelIndex& v) {
  if (map.occupancy(v) == Occupancy::kOccupied) return true;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      const VoxelIndex neighbour = v + step * VoxelIndex::Unit(axis);
      if (map.occupancy(neighbour) == Occupancy::kOccupied) return true;
    }
  }
  return false;
}

}  // namespace

PassingObstacles::PassingObstacles(const ExactScene& scene) : scene_(&scene) {
  for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
    const ExactScene::Shape& shape = scene.shapes()[i];
    if (!shape.alwaysThere()) obstacles_.push_back({&shape, i, {}, 0, {}, {}, {}});
  }
}

void PassingObstacles::add(const RangeData& scan, const Snapshot& map, double time) {
  for (Obstacle& obstacle : obstacles_) {
    if (obstacle.shape->exists(time)) {
      if (!obstacle.appeared) look(scan, map, time, &obstacle);
      noteTraces(map, time, &obstacle);
    }
    followTraces(scan, map, time, &obstacle);
  }
}

void PassingObstacles::look(const RangeData& scan, const Snapshot& map, double time,
                            Obstacle* obstacle) const {
  std::size_t hits = 0, found = 0;
  for (const Eigen::Vector3f& end : scan.returns) {
    const Eigen::Vector3d direction_W = end.cast<double>().normalized();
    const double distance = obstacle->shape->distanceAlong(scan.origin, direction_W, time);
    if (!std::isfinite(distance)) continue;
    if (scene_->firstHit(scan.origin, direction_W, time).shape != obstacle->shape) continue;
    ++hits;
    const VoxelIndex v = map.lattice().indexOf(scan.origin + distance * direction_W);
    if (isOccupiedNear(map, v)) ++found;
  }
  if (hits < kMinHits) return;
  if (!obstacle->first_seen) obstacle->first_seen = time;
  ++obstacle->scans_seen;
  if (found >= kAppearedShare * hits) obstacle->appeared = time;
}

/// Occupied voxels in a box around the obstacle that it reaches into, and nothing static does.
void PassingObstacles::noteTraces(const Snapshot& map, double time, Obstacle* obstacle) const {
  const double resolution = map.lattice().resolution();
  const ExactScene::Shape& shape = *obstacle->shape;
  const double moving_for = std::isfinite(shape.on) ? time - shape.on : 0.0;
  const Eigen::Vector3d center_W = shape.center + shape.velocity * moving_for;
  const Eigen::Vector3d reach =
      Eigen::Vector3d::Constant(shape.half_size.norm() + 2.0 * resolution);
  const VoxelBox box = {map.lattice().indexOf(center_W - reach),
                        map.lattice().indexOf(center_W + reach)};
  for (const VoxelIndex& v : map.voxels(Plane::kOccupied, box)) {
    const Eigen::Vector3d middle_W = map.lattice().centerOf(v);
    if (shape.signedDistance(middle_W, time) < kWithin * resolution) {
      obstacle->traces.try_emplace(keyOf(v), Trace{v, {}});
    }
  }
}

void PassingObstacles::followTraces(const RangeData& scan, const Snapshot& map, double time,
                                    Obstacle* obstacle) const {
  const double resolution = map.lattice().resolution();
  for (auto entry = obstacle->traces.begin(); entry != obstacle->traces.end();) {
    Trace& trace = entry->second;
    const Eigen::Vector3d center_W = map.lattice().centerOf(trace.voxel);
    const bool has_left = scene_->signedDistance(center_W, time) > kLeftBeyond * resolution;
    if (!has_left) trace.seen_through.reset();  // it came back
    if (has_left && !trace.seen_through && isSeenThrough(scan, center_W, resolution, time)) {
      trace.seen_through = time;
    }
    const Occupancy state = map.occupancy(trace.voxel);
    if (state == Occupancy::kOccupied) {
      ++entry;
      continue;
    }
    if (state == Occupancy::kFree && trace.seen_through) {
      obstacle->vanish_times.push_back(time - *trace.seen_through);
    }
    entry = obstacle->traces.erase(entry);
  }
}

/// Whether an exact ray passes the middle of the voxel.
bool PassingObstacles::isSeenThrough(const RangeData& scan, const Eigen::Vector3d& center_W,
                                     double resolution, double time) const {
  const Eigen::Vector3d to_center = center_W - scan.origin;
  const double distance = to_center.norm();
  const double within = kWithin * resolution;
  for (const Eigen::Vector3f& end : scan.returns) {
    const Eigen::Vector3d ray = end.cast<double>();
    const double along = ray.dot(to_center);
    // Most rays point elsewhere; no root is needed to see it.
    if (along <= 0.0 ||
        (distance * distance - within * within) * ray.squaredNorm() > along * along) {
      continue;
    }
    if (scene_->firstHit(scan.origin, ray.normalized(), time).distance > distance + within) {
      return true;
    }
  }
  return false;
}

nlohmann::json PassingObstacles::json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const Obstacle& obstacle : obstacles_) {
    if (!obstacle.first_seen) continue;
    std::size_t left = 0, never_seen_through = 0;
    for (const auto& [key, trace] : obstacle.traces) {
      ++(trace.seen_through ? left : never_seen_through);
    }
    const Quantiles vanish = quantilesOf(obstacle.vanish_times);
    nlohmann::json json = {{"primitive", obstacle.number},
                           {"first_seen_s", *obstacle.first_seen},
                           {"appear_s", nullptr},
                           {"scans_to_appear", obstacle.scans_seen},
                           {"cleared", obstacle.vanish_times.size()},
                           {"vanish_median_s", vanish.median},
                           {"vanish_p95_s", vanish.p95},
                           {"vanish_max_s", vanish.max},
                           {"left", left},
                           {"never_seen_through", never_seen_through}};
    if (obstacle.appeared) json["appear_s"] = *obstacle.appeared - *obstacle.first_seen;
    list.push_back(json);
  }
  return list;
}

}  // namespace fiimap
