#include <memory>
#include <string>
#include <vector>

#include "experiments.h"
#include "interleave.h"
#include "mapping_method.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

struct Comparison {
  double resolution;  // m
  std::vector<std::string> methods;
};

/// The slow ones are left out where one frame of them takes a large part of a second.
const std::vector<Comparison>& comparisons() {
  static const std::vector<Comparison> list = {
      {0.2, {kFiimap, kEgoStyle, kEgoStyleAsShipped, kPerPixel, kOctomap}},
      {0.1, {kFiimap, kEgoStyle, kEgoStyleAsShipped, kPerPixel, kOctomap}},
      {0.05, {kFiimap, kEgoStyle, kEgoStyleAsShipped}},
  };
  return list;
}

}  // namespace

void measurePipelines(const Recording& recording, Samples* samples) {
  const std::vector<Frame>& frames = recording.frames;
  for (const Comparison& comparison : comparisons()) {
    const MapperConfig config = configAt(comparison.resolution, kReach);
    const nlohmann::json setting = {{"resolution", comparison.resolution}};
    std::vector<std::unique_ptr<MappingMethod>> methods;
    std::vector<Series> series;
    for (const std::string& name : comparison.methods) {
      methods.push_back(makeMethod(name, config, frames));
      series.push_back({"pipeline", recording.name, name, setting, {}});
    }
    interleave(methods.size(), frames.size(), [&](std::size_t method, std::size_t frame) {
      series[method].values.push_back(
          microsecondsOf([&] { methods[method]->integrate(frames[frame]); }));
    });
    for (const Series& one : series) samples->add(one);
  }
}

void runPipelineOnce(const Recording& recording, const std::string& method_name,
                     double resolution) {
  const auto method = makeMethod(method_name, configAt(resolution, kReach), recording.frames);
  for (const Frame& frame : recording.frames) method->integrate(frame);
}

}  // namespace fiimap::bench
