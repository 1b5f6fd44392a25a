#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiimap/mapper_config.h"
#include "recording.h"

namespace fiimap::bench {

/// The end of one pixel's ray.
struct PixelPoint {
  Eigen::Vector3d end_W;
  bool is_return;  ///< false: the ray is free up to and including its end
};

/// Back-projects every pixel of the configured step on its own with a matrix product in double
/// precision, the textbook way; of a cloud, every point. Readings are judged as DepthProjector and
/// PointProjector do.
void projectPixels(const Frame& frame, const MapperConfig& config, std::vector<PixelPoint>* points);

/// Cuts a ray off where it leaves the box (voxel units); it is no return any more then.
/// \return false when the ray never enters the box.
bool clipToBox(const Eigen::Vector3d& origin, const VoxelBox& box, Eigen::Vector3d* end,
               bool* is_return);

}  // namespace fiimap::bench
