#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fiimap/structuring_element.h"

namespace fiimap {

/// What a reading without a usable distance says about its ray.
enum class ReadingPolicy {
  kIgnore,  ///< nothing
  kFree,    ///< the ray is free up to the maximum range
};

/// What the window of the map does.
enum class MapMode {
  kSliding,  ///< the window follows the vehicle
  kFixed,    ///< the window stays where map_center_* puts it
};

/// How the inflated layer is kept up to date; all give the same one.
enum class InflationMethod {
  kIncremental,  ///< dirty columns of bit planes
  kBfs,          ///< the paper's Algorithms 1 and 2, made exact
  kBatch,        ///< clear and re-dilate everything
};

/// How the readings of a sensor are understood.
struct ReadingConfig {
  ///@{
  /// Of depth images. depth_scale is in metres per unit, border_margin and pixel_step in pixels
  /// (the step is that of organised clouds, too), the others in metres along the optical axis.
  double depth_scale = 0.001;
  double min_depth = 0.3;
  double max_depth = 8.0;
  int pixel_step = 2;
  int border_margin = 2;
  ReadingPolicy invalid_depth = ReadingPolicy::kIgnore;
  ReadingPolicy infinite_depth = ReadingPolicy::kFree;
  ReadingPolicy beyond_max_depth = ReadingPolicy::kFree;
  ///@}
  double min_ray_length = 0.3;  ///< m; nearer points are ignored
  double max_ray_length = 8.0;  ///< m; rays are cut off here

  /// \param prefix of the parameters' names in the text.
  /// \throws std::invalid_argument that names the parameter, its value and what is allowed.
  void validate(const std::string& prefix = "") const;
};

/// Every setting of the map, in one place with its default. Names are the parameter names of the
/// nodelet and of fiimap_eval; units, ranges and meanings: mapper_parameters.cpp and
/// config/default.yaml.
struct MapperConfig : ReadingConfig {
  ///@{
  /// Voxels, the window and what a scan may change of it, metres; memory_limit in MB, 0: what the
  /// machine has.
  double resolution = 0.1;
  MapMode map_mode = MapMode::kSliding;
  double map_size_x = 100.0;
  double map_size_y = 100.0;
  double map_size_z = 6.0;
  double map_center_x = 0.0;
  double map_center_y = 0.0;
  double map_center_z = 0.0;
  double slide_distance = 0.4;
  double local_update_range_x = 16.0;
  double local_update_range_y = 16.0;
  double local_update_range_z = 6.0;
  double memory_limit = 0.0;
  ///@}

  double ray_end_cut = 2.25;    ///< voxel edges; see RayCaster
  double min_hit_cover = 0.05;  ///< share of a voxel's face; see HitCover
  bool round_rays = true;       ///< see RayCaster

  double body_size_x = 0.0;  ///< m; see IgnoredVolumes
  double body_size_y = 0.0;  ///< m
  double body_size_z = 0.0;  ///< m
  bool clear_body = false;   ///< see IgnoredVolumes::freeBody()

  double decay_time = 0.0;  ///< s; see Decay
  ///@{
  /// Probabilities of occupancy (eq. 6-8), 0 to 1.
  double p_hit = 0.65;
  double p_miss = 0.30;
  double p_min = 0.12;
  double p_max = 0.97;
  double p_occ = 0.80;
  ///@}

  ///@{
  /// See StructuringElement and InflationMethod; the radius in metres, the connectivity 6, 18
  /// or 26.
  double inflation_radius = 0.2;
  ElementShape inflation_shape = ElementShape::kBall;
  InflationMethod inflation_method = InflationMethod::kIncremental;
  int bfs_connectivity = 6;
  ///@}

  ///@{
  /// Whether queries see VirtualWalls, and their heights, metres in the map frame.
  bool virtual_walls = false;
  double virtual_floor = -0.1;
  double virtual_ceiling = 3.0;
  ///@}

  /// One for each sensor of a map that has several. Empty: one sensor, read as said above.
  std::vector<ReadingConfig> sensors;

  ///@{
  /// Three parameters as one vector, metres.
  Eigen::Vector3d mapSize() const { return {map_size_x, map_size_y, map_size_z}; }
  Eigen::Vector3d mapCenter() const { return {map_center_x, map_center_y, map_center_z}; }
  Eigen::Vector3d localUpdateRange() const {
    return {local_update_range_x, local_update_range_y, local_update_range_z};
  }
  Eigen::Vector3d bodySize() const { return {body_size_x, body_size_y, body_size_z}; }
  ///@}
  /// At least one.
  std::size_t sensorCount() const { return sensors.empty() ? 1 : sensors.size(); }
  /// How a sensor's readings are understood.
  const ReadingConfig& readingOf(std::size_t sensor) const {
    return sensors.empty() ? *this : sensors.at(sensor);
  }
  /// The configuration of a map that has this sensor alone.
  MapperConfig withOnly(std::size_t sensor) const;

  /// By which obstacles are inflated.
  StructuringElement structuringElement() const {
    return {inflation_shape, inflation_radius, resolution};
  }

  /// \throws std::invalid_argument that names the parameter, its value and what is allowed.
  void validate() const;
};

}  // namespace fiimap
