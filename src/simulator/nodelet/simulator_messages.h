#pragma once

#include <fiimap/SimulatorTruth.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <string>
#include <vector>

#include "simulator.h"

namespace fiimap::sim {

/// \throws std::invalid_argument that says what is wrong with the command.
/// \param frame that it must be in.
Setpoint toSetpoint(const trajectory_msgs::MultiDOFJointTrajectory& command,
                    const std::string& frame);

/// \param header of the odometry frame, with the time of the sample.
nav_msgs::Odometry toOdometry(const OdometrySample& sample, const std_msgs::Header& header,
                              const std::string& body_frame);
geometry_msgs::TransformStamped toTransform(const Eigen::Isometry3d& T_parent_child,
                                            const std_msgs::Header& header,
                                            const std::string& child_frame);

SimulatorTruth toTruth(const Quadrotor::State& vehicle, const FlightRecord& record,
                       const std_msgs::Header& header);

/// 16UC1. \param header of the optical frame.
sensor_msgs::Image toImage(const std::vector<std::uint16_t>& millimetres,
                           const CameraConfig& camera, const std_msgs::Header& header);
sensor_msgs::CameraInfo toCameraInfo(const CameraConfig& camera, const std_msgs::Header& header);

/// x, y, z in 32 bits, not organised. \param header of the LiDAR's frame.
sensor_msgs::PointCloud2 toCloud(const std::vector<Eigen::Vector3f>& points,
                                 const std_msgs::Header& header);

/// All that stands still, as triangles, and the goal.
visualization_msgs::MarkerArray toWorldMarkers(const World& world, const std_msgs::Header& header);
/// The vehicle as a ball of its radius, and the moving obstacles, at a time.
visualization_msgs::MarkerArray toMovingMarkers(const World& world, double time,
                                                const Quadrotor::State& vehicle, double radius,
                                                const std_msgs::Header& header);

}  // namespace fiimap::sim
