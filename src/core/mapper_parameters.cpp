#include <cmath>
#include <stdexcept>
#include <string>

#include "fiimap/parameters.h"
#include "memory_need.h"

namespace fiimap {
namespace {

constexpr double kMinResolution = 0.01, kMaxResolution = 10.0;  // m
constexpr double kMaxMapSize = 10000.0;                         // m
constexpr double kMaxCenter = 1e7;                              // m
constexpr double kMaxRadius = 100.0;                            // m
constexpr int kMaxReach = 64;                                   // voxels
constexpr double kMaxWindowVoxels = 1e10;
constexpr double kMaxBody = 10.0;          // m
constexpr double kMaxDecayTime = 86400.0;  // s
constexpr double kMaxMemory = 1e6;         // MB

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

Parameter connectivityParameter(int* field) {
  const std::string name = "bfs_connectivity";
  const std::string allowed = "6, 18 or 26";
  return {name,
          "",
          allowed,
          "neighbours visited by the method bfs",
          [field] { return std::to_string(*field); },
          [=](const std::string& text) {
            for (const int connectivity : {6, 18, 26}) {
              if (text != std::to_string(connectivity)) continue;
              *field = connectivity;
              return;
            }
            refuse("parameter " + name + " = '" + text + "': must be " + allowed);
          },
          ValueKind::kInteger,
          6.0,
          26.0,
          {"6", "18", "26"}};
}

Parameter updateRangeParameter(const std::string& name, double* field) {
  return tunable(numberParameter(name, field, kMinResolution, kMaxMapSize, "m",
                                 "full extent of the box around the vehicle that scans may "
                                 "change"));
}

/// Those of the window.
std::vector<Parameter> windowParameters(MapperConfig* c) {
  return {
      numberParameter("resolution", &c->resolution, kMinResolution, kMaxResolution, "m",
                      "edge length of a voxel"),
      choiceParameter("map_mode", &c->map_mode, {"sliding", "fixed"},
                      "whether the window follows the vehicle or stays around map_center"),
      numberParameter("map_size_x", &c->map_size_x, kMinResolution, kMaxMapSize, "m",
                      "extent of the window along x"),
      numberParameter("map_size_y", &c->map_size_y, kMinResolution, kMaxMapSize, "m",
                      "extent of the window along y"),
      numberParameter("map_size_z", &c->map_size_z, kMinResolution, kMaxMapSize, "m",
                      "extent of the window along z"),
      numberParameter("map_center_x", &c->map_center_x, -kMaxCenter, kMaxCenter, "m",
                      "middle of a fixed window"),
      numberParameter("map_center_y", &c->map_center_y, -kMaxCenter, kMaxCenter, "m",
                      "middle of a fixed window"),
      numberParameter("map_center_z", &c->map_center_z, -kMaxCenter, kMaxCenter, "m",
                      "middle of a fixed window"),
      tunable(numberParameter("slide_distance", &c->slide_distance, 0.0, kMaxMapSize, "m",
                              "how far the vehicle may leave the window's middle along an axis "
                              "before the window follows on that axis")),
      updateRangeParameter("local_update_range_x", &c->local_update_range_x),
      updateRangeParameter("local_update_range_y", &c->local_update_range_y),
      updateRangeParameter("local_update_range_z", &c->local_update_range_z),
      numberParameter("memory_limit", &c->memory_limit, 0.0, kMaxMemory, "MB",
                      "a map that may need more when all is seen is refused at start; 0: the "
                      "machine's memory"),
  };
}

/// Those of the rays that hold for all sensors, and of the voxels.
std::vector<Parameter> occupancyParameters(MapperConfig* c) {
  return tunable({
      numberParameter("ray_end_cut", &c->ray_end_cut, 0.0, 100.0, "voxels",
                      "a ray frees voxels up to this far in front of the surface that it met"),
      numberParameter("min_hit_cover", &c->min_hit_cover, 0.0, 1.0, "of a voxel's face",
                      "depth images: a voxel that rays pass is hit if returns cover this share"),
      flagParameter("round_rays", &c->round_rays,
                    "directions of rays are rounded, so that they share their way: faster"),

      numberParameter("body_size_x", &c->body_size_x, 0.0, kMaxBody, "m",
                      "extent of the vehicle's body, in which returns are ignored; 0: none"),
      numberParameter("body_size_y", &c->body_size_y, 0.0, kMaxBody, "m",
                      "extent of the vehicle's body, in which returns are ignored; 0: none"),
      numberParameter("body_size_z", &c->body_size_z, 0.0, kMaxBody, "m",
                      "extent of the vehicle's body, in which returns are ignored; 0: none"),
      flagParameter("clear_body", &c->clear_body,
                    "every scan sees the voxels in the vehicle's body as free"),

      numberParameter("decay_time", &c->decay_time, 0.0, kMaxDecayTime, "s",
                      "what no scan saw for one to two such times is unknown again; 0: never"),

      numberParameter("p_hit", &c->p_hit, 0.501, 0.999, "",
                      "probability of occupancy after one hit (eq. 6)"),
      numberParameter("p_miss", &c->p_miss, 0.001, 0.499, "",
                      "probability of occupancy after one miss (eq. 6)"),
      numberParameter("p_min", &c->p_min, 0.001, 0.499, "",
                      "lower clamp of the probability (eq. 8)"),
      numberParameter("p_max", &c->p_max, 0.501, 0.999, "",
                      "upper clamp of the probability (eq. 8)"),
      numberParameter("p_occ", &c->p_occ, 0.501, 0.999, "",
                      "a voxel is occupied from this probability on"),
  });
}

std::vector<Parameter> inflationParameters(MapperConfig* c) {
  return tunable({
      numberParameter("inflation_radius", &c->inflation_radius, 0.0, kMaxRadius, "m",
                      "how far obstacles are inflated; at most 64 voxels"),
      choiceParameter("inflation_shape", &c->inflation_shape, {"ball", "cube", "diamond"},
                      "shape of the structuring element"),
      choiceParameter("inflation_method", &c->inflation_method, {"incremental", "bfs", "batch"},
                      "how the inflated layer is kept; all give the same result"),
      connectivityParameter(&c->bfs_connectivity),

      flagParameter("virtual_walls", &c->virtual_walls,
                    "whether queries treat everything below virtual_floor and above "
                    "virtual_ceiling as an obstacle"),
      numberParameter("virtual_floor", &c->virtual_floor, -kMaxCenter, kMaxCenter, "m",
                      "height of the virtual floor"),
      numberParameter("virtual_ceiling", &c->virtual_ceiling, -kMaxCenter, kMaxCenter, "m",
                      "height of the virtual ceiling"),
  });
}

}  // namespace

std::vector<Parameter> mapperParameters(MapperConfig* c) {
  std::vector<Parameter> all = windowParameters(c);
  for (const auto& part : {readingParameters(c), occupancyParameters(c), inflationParameters(c)}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

void MapperConfig::validate() const {
  MapperConfig copy = *this;
  for (const Parameter& parameter : mapperParameters(&copy)) parameter.set(parameter.get());

  for (std::size_t sensor = 0; sensor < sensorCount(); ++sensor) readingOf(sensor).validate();
  const bool has_body = bodySize().minCoeff() > 0.0;
  if (!has_body && (clear_body || bodySize().maxCoeff() > 0.0)) {
    refuse("parameters body_size_x/y/z: all must be above 0, or all 0 and clear_body false");
  }
  requireLess("p_occ", p_occ, "p_max", p_max);
  requireLess("p_min", p_min, "p_miss", p_miss);
  if (virtual_walls) {
    requireLess("virtual_floor", virtual_floor, "virtual_ceiling", virtual_ceiling);
  }
  const double max_slide = mapSize().minCoeff() / 2.0;
  if (map_mode == MapMode::kSliding && slide_distance > max_slide) {
    refuse("parameter slide_distance = " + std::to_string(slide_distance) + ": must be in [0, " +
           std::to_string(max_slide) +
           "] m, half of the smallest of map_size_x/y/z, or the vehicle would leave the window");
  }
  if (inflation_radius / resolution > kMaxReach) {
    refuse("parameter inflation_radius = " + std::to_string(inflation_radius) +
           ": must be at most " + std::to_string(kMaxReach) + " voxels of " +
           std::to_string(resolution) + " m");
  }
  const double voxels = (mapSize() / resolution).prod();
  if (voxels > kMaxWindowVoxels) {
    refuse("parameters map_size_x/y/z and resolution: the window would have " +
           std::to_string(voxels) + " voxels, must be at most " + std::to_string(kMaxWindowVoxels));
  }
  requireMemory(*this);
}

}  // namespace fiimap
