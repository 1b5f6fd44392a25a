#include "ego_parameters.h"

#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace {

using fiimap::ParameterMap;

const char* const kOwnPrefix = "fiimap/";
const char* const kAxes[] = {"x", "y", "z"};

/// Reads values and remembers which were asked for.
class Reader {
 public:
  explicit Reader(const ParameterMap& values) : values_(values) {}

  std::string text(const std::string& name, const std::string& fallback) {
    asked_.push_back(name);
    const auto found = values_.find(name);
    return found == values_.end() ? fallback : found->second;
  }
  double number(const std::string& name, double fallback) {
    const std::string value = text(name, toText(fallback));
    std::istringstream stream(value);
    stream.imbue(std::locale::classic());
    double number = 0.0;
    if (!(stream >> number)) {
      throw std::invalid_argument("parameter grid_map/" + name + " = '" + value +
                                  "': must be a number");
    }
    return number;
  }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::vector<std::string> unasked() const {
    std::vector<std::string> names;
    for (const auto& [name, value] : values_) {
      const bool is_own = name.rfind(kOwnPrefix, 0) == 0;
      const bool was_asked = std::find(asked_.begin(), asked_.end(), name) != asked_.end();
      if (!is_own && !was_asked) names.push_back(name);
    }
    return names;
  }

  static std::string toText(double value) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(std::numeric_limits<double>::digits10);
    text << value;
    return text.str();
  }

 private:
  const ParameterMap& values_;
  std::vector<std::string> asked_;
};

/// The box of an update; ego-planner tells half of its edges.
/// \return the edges, m.
Eigen::Vector3d readUpdateRange(Reader* reader, EgoParameters* ego) {
  const double half_extents[] = {5.5, 5.5, 4.5};  // m
  Eigen::Vector3d range;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("local_update_range_") + kAxes[axis];
    range[axis] = 2.0 * reader->number(name, half_extents[axis]);
    ego->mapping[name] = Reader::toText(range[axis]);
  }
  return range;
}

/// Version 2: a window that follows the vehicle, as large as the box of an update.
void readMovingExtent(Reader* reader, EgoParameters* ego) {
  ParameterMap& map = ego->mapping;
  const Eigen::Vector3d range = readUpdateRange(reader, ego);
  map["map_mode"] = "sliding";
  for (int axis = 0; axis < 3; ++axis) {
    map[std::string("map_size_") + kAxes[axis]] = Reader::toText(range[axis]);
  }
  map["virtual_walls"] = reader->text("enable_virtual_wall", "false");
  map["virtual_floor"] = reader->text("virtual_ground", "-1");
  map["virtual_ceiling"] = reader->text("virtual_ceil", "3");
  // It has no limits of its own: a ray ends where the window does.
  map["max_ray_length"] = map["max_depth"] = Reader::toText(range.norm() / 2.0);
}

/// A fixed window around the origin, from the ground up, as large as ego-planner's array.
void readFixedExtent(Reader* reader, EgoParameters* ego) {
  ParameterMap& map = ego->mapping;
  const Eigen::Vector3d size(reader->number("map_size_x", 40.0), reader->number("map_size_y", 40.0),
                             reader->number("map_size_z", 3.0));
  const double ground = reader->number("ground_height", -0.01);
  ego->low = {-size.x() / 2.0, -size.y() / 2.0, ground};
  ego->high = ego->low + size;
  map["map_mode"] = "fixed";
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = kAxes[axis];
    map["map_size_" + name] = Reader::toText(size[axis]);
    map["map_center_" + name] = Reader::toText((ego->low[axis] + ego->high[axis]) / 2.0);
  }
  readUpdateRange(reader, ego);
  map["max_ray_length"] = reader->text("max_ray_length", "4.5");
  map["max_depth"] = reader->text("depth_filter_maxdist", "5.0");
  const double ceiling = reader->number("virtual_ceil_height", -0.1);
  map["virtual_walls"] = ceiling > ground ? "true" : "false";
  map["virtual_floor"] = Reader::toText(ground);
  map["virtual_ceiling"] = Reader::toText(std::max(ceiling, ground + 1.0));
}

void readSensor(Reader* reader, EgoParameters* ego) {
  ParameterMap& map = ego->mapping;
  const std::string sensor = reader->text("sensor", "depth");
  if (sensor != "depth" && sensor != "cloud") {
    throw std::invalid_argument("parameter grid_map/sensor = '" + sensor +
                                "': must be depth or cloud");
  }
  ego->has_cloud_sensor = sensor == "cloud";
  ego->has_camera_pose = reader->number("pose_type", 1.0) == 1.0;
  ego->cx = reader->number("cx", 0.0);
  ego->cy = reader->number("cy", 0.0);
  ego->fx = reader->number("fx", 0.0);
  ego->fy = reader->number("fy", 0.0);
  map["sensor"] = ego->has_cloud_sensor ? "points" : "depth";
  // Clouds come to the map with poses of their own.
  const bool by_pose = ego->has_cloud_sensor || ego->has_camera_pose;
  map["pose_source"] = by_pose ? "pose" : "odometry";
  map["extrinsics"] = "parameter";
  map["extrinsic_translation"] = by_pose || ego->is_version_2 ? "0 0 0" : "0 0 -0.02";
  map["extrinsic_rotation"] = by_pose ? "0 0 0 1" : "-0.5 0.5 -0.5 0.5";
  map["depth_scale"] = Reader::toText(1.0 / reader->number("k_depth_scaling_factor", 1000.0));
  map["min_depth"] = reader->text("depth_filter_mindist", "0.2");
  map["border_margin"] = reader->text("depth_filter_margin", "1");
  map["pixel_step"] = ego->has_cloud_sensor ? "1" : reader->text("skip_pixel", "2");
}

}  // namespace

EgoParameters readEgoParameters(const ParameterMap& values) {
  EgoParameters ego;
  Reader reader(values);
  ParameterMap& map = ego.mapping;
  map["map_frame"] = reader.text("frame_id", "world");
  map["resolution"] = reader.text("resolution", "0.1");
  map["inflation_radius"] = reader.text("obstacles_inflation", "0.099");
  map["inflation_shape"] = reader.text("inflation_shape", "cube");
  for (const auto& [name, fallback] : ParameterMap{{"p_hit", "0.65"},
                                                   {"p_miss", "0.35"},
                                                   {"p_min", "0.12"},
                                                   {"p_max", "0.90"},
                                                   {"p_occ", "0.80"},
                                                   {"min_ray_length", "0.1"}}) {
    map[name] = reader.text(name, fallback);
  }
  for (const char* name : {"virtual_ceil", "virtual_ground", "enable_virtual_wall"}) {
    ego.is_version_2 = ego.is_version_2 || reader.has(name);
  }
  if (ego.is_version_2) {
    readMovingExtent(&reader, &ego);
  } else {
    readFixedExtent(&reader, &ego);
  }
  readSensor(&reader, &ego);
  ego.odom_depth_timeout = reader.number("odom_depth_timeout", ego.odom_depth_timeout);
  const std::string prefix = kOwnPrefix;
  for (const auto& [name, value] : values) {
    if (name.rfind(prefix, 0) == 0) map[name.substr(prefix.size())] = value;
  }
  ego.ignored = reader.unasked();
  return ego;
}
