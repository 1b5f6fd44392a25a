#include <memory>
#include <string>
#include <utility>

#include "experiments.h"
#include "interleave.h"
#include "mapping_method.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

struct Variant {
  nlohmann::json setting;
  MapperConfig config;
};

std::vector<Variant> resolutions() {
  std::vector<Variant> variants;
  constexpr double kRadius = 0.2;  // m
  for (const double resolution : {0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05}) {
    MapperConfig config;
    config.resolution = resolution;
    config.inflation_radius = kRadius;
    variants.push_back({{{"resolution", resolution}}, config});
  }
  return variants;
}

std::vector<Variant> windows() {
  std::vector<Variant> variants;
  for (const Eigen::Vector3d& size :
       {Eigen::Vector3d(20.0, 20.0, 6.0), Eigen::Vector3d(100.0, 100.0, 6.0),
        Eigen::Vector3d(400.0, 400.0, 12.0)}) {
    MapperConfig config = configAt(kResolution, kReach);
    config.map_size_x = size.x();
    config.map_size_y = size.y();
    config.map_size_z = size.z();
    variants.push_back({{{"window", {size.x(), size.y(), size.z()}}}, config});
  }
  return variants;
}

std::vector<Variant> ranges() {
  std::vector<Variant> variants;
  for (const double range : {2.0, 3.0, 4.0, 6.0, 8.0}) {
    MapperConfig config = configAt(kResolution, kReach);
    config.max_depth = range;
    config.max_ray_length = range;
    config.local_update_range_x = 2.0 * range;
    config.local_update_range_y = 2.0 * range;
    variants.push_back({{{"range", range}}, config});
  }
  return variants;
}

std::vector<Variant> reaches() {
  std::vector<Variant> variants;
  for (int reach = 1; reach <= 10; ++reach) {
    variants.push_back({{{"reach", reach}}, configAt(kResolution, reach)});
  }
  return variants;
}

void measure(const std::string& experiment, const Recording& recording,
             const std::vector<Variant>& variants, Samples* samples) {
  const std::vector<Frame>& frames = recording.frames;
  std::vector<std::unique_ptr<MappingMethod>> maps;
  std::vector<Series> series;
  for (const Variant& variant : variants) {
    maps.push_back(makeMethod(kFiimap, variant.config, frames));
    series.push_back({experiment, recording.name, kFiimap, variant.setting, {}});
  }
  interleave(maps.size(), frames.size(), [&](std::size_t map, std::size_t frame) {
    series[map].values.push_back(microsecondsOf([&] { maps[map]->integrate(frames[frame]); }));
  });
  for (const Series& one : series) samples->add(one);
}

}  // namespace

void measureGrowth(const Recording& recording, Samples* samples) {
  measure("growth_resolution", recording, resolutions(), samples);
  measure("growth_window", recording, windows(), samples);
  measure("growth_range", recording, ranges(), samples);
  measure("growth_reach", recording, reaches(), samples);
}

}  // namespace fiimap::bench
