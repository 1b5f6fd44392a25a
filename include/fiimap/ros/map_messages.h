#pragma once

#include <fiimap/MapInfo.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "fiimap/snapshot.h"

namespace fiimap {

/// Header with the stamp of the newest scan of a snapshot.
std_msgs::Header toHeader(const Snapshot& snapshot, const std::string& map_frame);

MapInfo toMapInfo(const Snapshot& snapshot, const std::string& id, const std::string& map_frame);

/// A cloud without points, fields x y z (float32, m).
sensor_msgs::PointCloud2 emptyCloud(const std_msgs::Header& header);

/// Centres of the set voxels of a plane in the whole window, fields x y z (float32, m).
sensor_msgs::PointCloud2 toPointCloud(const Snapshot& snapshot, Plane plane,
                                      const std::string& map_frame);

/// Edges of a box of voxels.
/// \param name namespace of the marker.
visualization_msgs::Marker toOutline(const VoxelBox& box, const Snapshot& snapshot,
                                     const std::string& map_frame, const std::string& name);

}  // namespace fiimap
