// A map without ROS: a camera flies ahead to a wall about 5 m away.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <vector>

#include "fiimap/map_handle.h"
#include "fiimap/mapper.h"
#include "fiimap/parameters.h"

namespace {

constexpr double kWall = 5.05;  // m ahead of the world's origin
constexpr double kSpeed = 1.0;  // m/s
constexpr double kRate = 10.0;  // images per second
constexpr int kImages = 10;

/// Parameters by the names of config/default.yaml, as text from whatever source you have.
fiimap::MapperConfig makeConfig() {
  fiimap::MapperConfig config;
  const fiimap::ParameterMap values = {{"inflation_radius", "0.3"}, {"map_size_x", "20"}};
  for (const auto& name : fiimap::applyParameters(values, fiimap::mapperParameters(&config))) {
    std::printf("no such parameter: %s\n", name.c_str());
  }
  return config;
}

/// The camera looks along the world's x: its z (ahead), x (right) and y (down) in world axes.
fiimap::ScanPose poseAt(double time) {
  fiimap::ScanPose pose;
  pose.T_W_S.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.T_W_S.translation() = Eigen::Vector3d(kSpeed * time, 0.0, 1.0);
  pose.vehicle_W = pose.T_W_S.translation();
  pose.stamp_ns = static_cast<std::int64_t>(time * 1e9);
  return pose;
}

void makeMap(fiimap::MapHandle* handle) {
  fiimap::Mapper mapper(makeConfig());  // throws when a value is not allowed
  const fiimap::PinholeIntrinsics intrinsics{300.0, 300.0, 160.0, 120.0};
  std::vector<float> pixels(320 * 240);
  fiimap::DepthImage image;
  image.format = fiimap::DepthImage::Format::kFloat32;
  image.width = 320;
  image.height = 240;
  image.row_bytes = 320 * sizeof(float);
  image.data = pixels.data();

  for (int i = 0; i < kImages; ++i) {
    const fiimap::ScanPose pose = poseAt(i / kRate);
    std::fill(pixels.begin(), pixels.end(), static_cast<float>(kWall - pose.vehicle_W.x()));
    try {
      mapper.integrate(image, intrinsics, pose);
    } catch (const std::exception& error) {  // a pose that is not finite, an image without pixels
      std::printf("image %d is left out: %s\n", i, error.what());
      continue;  // the map is as it was
    }
    handle->publish(mapper.snapshot());
  }
}

/// May run in any thread, as often as it likes.
void askMap(const fiimap::MapHandle& handle) {
  const std::shared_ptr<const fiimap::Snapshot> map = handle.latest();
  if (!map) return;  // no scan yet
  const fiimap::ObstacleRules rules{fiimap::MapLayer::kInflated, fiimap::Unseen::kObstacle,
                                    fiimap::Unseen::kObstacle};
  const Eigen::Vector3d from(1.0, 0.0, 1.0), to(6.0, 0.0, 1.0);
  const auto hit = map->castRay(from, to, rules);
  std::printf("snapshot %d: %d occupied, %d inflated voxels\n",
              static_cast<int>(map->info().sequence),
              static_cast<int>(map->count(fiimap::Plane::kOccupied)),
              static_cast<int>(map->count(fiimap::Plane::kInflated)));
  std::printf("the way ahead is free for %.1f m\n",
              hit ? hit->distance : std::numeric_limits<double>::infinity());
}

}  // namespace

int main() {
  fiimap::MapHandle handle("/map");
  makeMap(&handle);
  askMap(handle);
}
