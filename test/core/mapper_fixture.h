#pragma once

#include <vector>

#include "fiimap/mapper.h"
#include "oracle.h"

namespace fiimap::test {

constexpr double kResolution = 0.25;

/// A window of 32 x 24 x 12 voxels; rays are not cut, so that hits and free voxels are obvious.
inline MapperConfig smallConfig() {
  MapperConfig config;
  config.resolution = kResolution;
  config.map_size_x = 8.0;
  config.map_size_y = 6.0;
  config.map_size_z = 3.0;
  config.local_update_range_x = 8.0;
  config.local_update_range_y = 6.0;
  config.local_update_range_z = 3.0;
  config.slide_distance = 1.0;
  config.inflation_radius = 0.5;
  config.ray_end_cut = 0.0;
  return config;
}

inline ScanPose poseAt(const Eigen::Vector3d& position_W, std::int64_t stamp_ns = 1) {
  ScanPose pose;
  pose.T_W_S.translation() = position_W;
  pose.vehicle_W = position_W;
  pose.stamp_ns = stamp_ns;
  return pose;
}

/// One point ahead, seen often enough to be occupied.
inline void seeAnObstacle(Mapper* mapper, const Eigen::Vector3d& from_W,
                          const Eigen::Vector3f& offset = {2.0f, 0.0f, 0.0f}) {
  for (int i = 0; i < 3; ++i) mapper->integrate({{offset}}, poseAt(from_W));
}

inline Eigen::Vector3d centerOfWindow(const Mapper& mapper) {
  const VoxelBox& window = mapper.grid().window();
  return kResolution * (window.min + window.size() / 2).cast<double>().array() + kResolution / 2;
}

inline MapperConfig withInflation(MapperConfig config, double radius, ElementShape shape) {
  config.inflation_radius = radius;
  config.inflation_shape = shape;
  return config;
}

/// What a planner could see of a map.
struct State {
  VoxelBox window;
  std::vector<VoxelIndex> known, occupied, inflated;

  explicit State(Mapper* mapper) {
    const auto snapshot = mapper->snapshot();
    window = snapshot->window();
    known = snapshot->voxels(Plane::kKnown, window);
    occupied = snapshot->voxels(Plane::kOccupied, window);
    inflated = snapshot->voxels(Plane::kInflated, window);
  }
  bool operator==(const State& o) const {
    return window == o.window && known == o.known && occupied == o.occupied &&
           inflated == o.inflated;
  }
};

}  // namespace fiimap::test
