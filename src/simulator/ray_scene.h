#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "worlds/world.h"

struct RTCRayHit16;

namespace fiimap::sim {

/// The surfaces of a world, ready for rays and distances. In single precision: a coordinate of
/// 100 m is exact to 0.01 mm. Reading is thread-safe, setTime() is not.
class RayScene {
 public:
  /// \throws std::runtime_error when Embree refuses.
  explicit RayScene(World world);
  ~RayScene();

  const World& world() const { return world_; }

  /// Moves the moving obstacles to where they are at a time, s, for rays.
  void setTime(double time);

  /// Traces 16 rays to what they meet first; the caller has filled origins, directions and limits.
  void intersect(RTCRayHit16* rays) const;

  /// Distance from a point to the nearest surface at a time, s, whatever setTime() said, m;
  /// `farthest` when there is none nearer.
  double distance(const Eigen::Vector3d& point_W, double time, double farthest) const;

 private:
  class Geometry;
  class Device;

  double distanceToMoving(const Eigen::Vector3d& point_W, double time, double farthest) const;

  World world_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Geometry> still_;
  std::unique_ptr<Geometry> moving_;  // null when nothing moves
};

}  // namespace fiimap::sim
