#pragma once

#include <fiimap/MapInfo.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "fiimap/ros/vehicle_path.h"
#include "fiimap/snapshot.h"

namespace fiimap {

/// Header of a stamp of the core, nanoseconds.
std_msgs::Header toHeader(std::int64_t stamp_ns, const std::string& map_frame);
/// With the stamp of the newest scan of a snapshot.
std_msgs::Header toHeader(const Snapshot& snapshot, const std::string& map_frame);

/// What ~map_handle tells of a snapshot.
/// \param id of the map's handle.
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

/// \param T_W_B body to the frame of the header.
geometry_msgs::PoseStamped toPose(const Eigen::Isometry3d& T_W_B, const std_msgs::Header& header);

/// Of an empty path: no poses and no stamp.
nav_msgs::Path toPath(const VehiclePath& path, const std::string& map_frame);

/// Axes of the vehicle's body at its newest pose: x red, y green, z blue. Of an empty path: a
/// marker that takes those away.
visualization_msgs::Marker toVehicleMarker(const VehiclePath& path, const std::string& map_frame);

}  // namespace fiimap
