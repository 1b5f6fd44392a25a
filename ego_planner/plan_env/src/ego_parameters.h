#pragma once

#include <string>
#include <vector>

#include <fiimap/parameters.h>
#include <Eigen/Core>

/// What ego-planner's parameters ~grid_map/... say, in the words of fiimap.
struct EgoParameters {
  fiimap::ParameterMap mapping;   ///< of the mapping nodelet
  bool has_cloud_sensor = false;  ///< clouds in the map frame instead of depth images
  bool has_camera_pose = false;   ///< pose_type 1: poses of the camera instead of odometry
  double cx = 0.0, cy = 0.0, fx = 0.0, fy = 0.0;  ///< pixels
  double odom_depth_timeout = 1.0;                ///< s
  /// EGO-Planner-v2: topics in the planner's own namespace, a window that follows the vehicle, and
  /// what is outside of it is free.
  bool is_version_2 = false;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< corner of the map, m; not of version 2
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  std::vector<std::string> ignored;  ///< names that have no effect here
};

/// \param values by the names after grid_map/; those below fiimap/ are taken as they are.
/// \throws std::invalid_argument that names a value that is missing or no number.
EgoParameters readEgoParameters(const fiimap::ParameterMap& values);
