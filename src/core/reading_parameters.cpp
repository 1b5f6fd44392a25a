#include <string>

#include "fiimap/parameters.h"

namespace fiimap {
namespace {

constexpr double kMinRange = 0.0, kMaxRange = 1000.0;  // m

}  // namespace

std::vector<Parameter> readingParameters(ReadingConfig* c, const std::string& prefix) {
  const auto policy = [](const std::string& name, ReadingPolicy* field,
                         const std::string& meaning) {
    return choiceParameter(name, field, {"ignore", "free"}, meaning);
  };
  return tunable({
      numberParameter(prefix + "depth_scale", &c->depth_scale, 1e-6, 1.0, "m per unit",
                      "metres per unit of a 16-bit depth image"),
      numberParameter(prefix + "min_depth", &c->min_depth, kMinRange, kMaxRange, "m",
                      "nearer depth readings are ignored"),
      numberParameter(prefix + "max_depth", &c->max_depth, kMinRange, kMaxRange, "m",
                      "farther depth readings are treated as beyond_max_depth says"),
      integerParameter(prefix + "pixel_step", &c->pixel_step, 0, 1000, "pixels",
                       "use every n-th pixel of every n-th row of images and organised clouds; 0: "
                       "the paper's eq. 5, samples at max_depth one voxel apart (clouds: 1)"),
      integerParameter(prefix + "border_margin", &c->border_margin, 0, 10000, "pixels",
                       "pixels to leave out at each border of a depth image"),
      policy(prefix + "invalid_depth", &c->invalid_depth,
             "what 0 and NaN readings mean for their ray"),
      policy(prefix + "infinite_depth", &c->infinite_depth,
             "what +inf readings mean for their ray"),
      policy(prefix + "beyond_max_depth", &c->beyond_max_depth,
             "what readings beyond max_depth or max_ray_length mean for their ray"),

      numberParameter(prefix + "min_ray_length", &c->min_ray_length, kMinRange, kMaxRange, "m",
                      "nearer points are ignored (the vehicle's own body)"),
      numberParameter(prefix + "max_ray_length", &c->max_ray_length, kMinRange, kMaxRange, "m",
                      "rays are cut off at this length; farther points do not mark obstacles"),
  });
}

void ReadingConfig::validate(const std::string& prefix) const {
  ReadingConfig copy = *this;
  for (const Parameter& parameter : readingParameters(&copy, prefix)) {
    parameter.set(parameter.get());
  }
  requireLess(prefix + "min_depth", min_depth, prefix + "max_depth", max_depth);
  requireLess(prefix + "min_ray_length", min_ray_length, prefix + "max_ray_length", max_ray_length);
}

MapperConfig MapperConfig::withOnly(std::size_t sensor) const {
  MapperConfig config = *this;
  static_cast<ReadingConfig&>(config) = readingOf(sensor);
  config.sensors.clear();
  return config;
}

}  // namespace fiimap
