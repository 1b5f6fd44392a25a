#pragma once

#include <fiimap/CastRays.h>
#include <fiimap/GetBox.h>
#include <fiimap/QueryPoints.h>
#include <geometry_msgs/Point.h>

#include <string>

#include "fiimap/snapshot.h"

namespace fiimap {

/// The voxels of a box between two points, with those that the points touch.
/// \throws std::invalid_argument, with the reason, when a point is not finite or too far away, or
/// max is less than min.
VoxelBox toVoxelBox(const VoxelLattice& lattice, const geometry_msgs::Point& min,
                    const geometry_msgs::Point& max);

///@{
/// Answers a query on one snapshot. What is not allowed (GetBox.srv, QueryPoints.srv,
/// CastRays.srv) is refused with the reason in the answer.
GetBox::Response queryBox(const Snapshot& snapshot, const GetBox::Request& request,
                          const std::string& map_frame);
QueryPoints::Response queryPoints(const Snapshot& snapshot, const QueryPoints::Request& request,
                                  const std::string& map_frame);
CastRays::Response castRays(const Snapshot& snapshot, const CastRays::Request& request,
                            const std::string& map_frame);
///@}

}  // namespace fiimap
