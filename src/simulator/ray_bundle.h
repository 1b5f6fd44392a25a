#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "ray_scene.h"

namespace fiimap::sim {

/// What the rays of a sensor met, in the order of its directions.
struct RayHits {
  std::vector<float> lengths;        ///< in units of the direction's length; infinity: nothing met
  std::vector<float> cos_incidence;  ///< |cosine| between ray and surface normal; only if asked for
};

/// The rays of a sensor from one origin. Not thread-safe (keeps scratch memory).
class RayBundle {
 public:
  /// \param directions_S in the sensor's frame, of any length; neighbours in the list should be
  /// neighbours in space, because groups of 16 are traced together.
  explicit RayBundle(std::vector<Eigen::Vector3f> directions_S);

  std::size_t size() const { return directions_S_.size(); }
  const std::vector<Eigen::Vector3f>& directions() const { return directions_S_; }

  /// \param T_W_S sensor to world; \param longest in units of the direction's length.
  const RayHits& cast(const RayScene& scene, const Eigen::Isometry3d& T_W_S, double longest,
                      bool with_incidence);

 private:
  std::vector<Eigen::Vector3f> directions_S_;
  RayHits hits_;
};

}  // namespace fiimap::sim
