#pragma once

#include "array_map.h"

namespace fiimap::bench {

/// The plain way: one Amanatides-Woo walk per pixel, from the camera to the end of the free part of
/// the ray, with our rules (rays end ray_end_cut voxels before a surface, a hit wins).
class PerPixelMap : public ArrayMap {
 public:
  using ArrayMap::ArrayMap;

 protected:
  void castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, bool is_return) override;
  bool isHit(std::uint16_t hits, std::uint16_t /*observations*/) const override { return hits > 0; }
};

}  // namespace fiimap::bench
