#include "plan_env/grid_map.h"

#include <stdexcept>

#include <fiimap/ros/parameter_sources.h>
#include <fiimap/snapshot.h>

#include "mapping.h"

GridMap::GridMap() = default;
GridMap::~GridMap() = default;

void GridMap::initMap(ros::NodeHandle& nh) {
  fiimap::ParameterMap values = fiimap::parameterMapFromRos(ros::NodeHandle(nh, "grid_map"));
  values.erase("fiimap");  // a namespace, read on its own
  for (const auto& [name, value] :
       fiimap::parameterMapFromRos(ros::NodeHandle(nh, "grid_map/fiimap"))) {
    values["fiimap/" + name] = value;
  }
  EgoParameters ego;
  try {
    ego = readEgoParameters(values);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    throw std::runtime_error(error.what());
  }
  for (const std::string& name : ego.ignored) {
    ROS_INFO("parameter grid_map/%s has no effect on this map", name.c_str());
  }
  timeout_ = ego.odom_depth_timeout;
  mapping_ = std::make_unique<Mapping>(
      nh, ego,
      [this](const std::shared_ptr<const fiimap::Snapshot>& snapshot) { snapshot_ = snapshot; });
  // Now it is known to be a number.
  resolution_ = std::stod(ego.mapping.at("resolution"));
}

int GridMap::getInflateOccupancy(Eigen::Vector3d position) {
  if (!snapshot_) return withoutSnapshot(position);
  switch (snapshot_->inflation(position)) {
    case fiimap::Inflation::kInflated:
      return 1;
    case fiimap::Inflation::kOutside:
      return outside(position);
    default:
      return 0;
  }
}

int GridMap::getOccupancy(Eigen::Vector3d position) {
  if (!snapshot_) return withoutSnapshot(position);
  switch (snapshot_->occupancy(position)) {
    case fiimap::Occupancy::kOccupied:
      return 1;
    case fiimap::Occupancy::kOutside:
      return outside(position);
    default:
      return 0;
  }
}

bool GridMap::getOdomDepthTimeout() {
  if (!snapshot_) return false;
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(snapshot_->info().stamp_ns));
  return (ros::Time::now() - stamp).toSec() > timeout_;
}

int GridMap::withoutSnapshot(const Eigen::Vector3d& position) const {
  if (!mapping_) return -1;
  const EgoParameters& ego = mapping_->parameters();
  const bool is_inside =
      (position.array() >= ego.low.array()).all() && (position.array() < ego.high.array()).all();
  return is_inside ? 0 : outside(position);
}

int GridMap::outside(const Eigen::Vector3d& position) const {
  return mapping_->parameters().is_version_2 && position.allFinite() ? 0 : -1;
}
