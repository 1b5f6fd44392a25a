// Any YAML file as configuration: refused with a sentence, or valid and a map can be made of it.

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "byte_source.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/parameter_sources.h"
#include "temporary_input.h"

namespace fiimap::fuzz {
namespace {

/// Larger maps only cost time here.
constexpr double kMostVoxels = 1e6;

void configureFrom(const std::string& file) {
  MapperConfig mapper;
  NodeConfig node;
  configure(parameterMapFromYaml(file), &mapper, &node);
  mapper.validate();
  node.validate();
  for (const auto& parameters : {mapperParameters(&mapper), nodeParameters(&node)}) {
    for (const Parameter& parameter : parameters) parameter.set(parameter.get());
  }
  const double voxels = (mapper.mapSize() / mapper.resolution).prod();
  const double updated = (mapper.localUpdateRange() / mapper.resolution).prod();
  if (voxels > kMostVoxels || updated > kMostVoxels) return;
  Mapper map(mapper);
  map.integrate(PointScan{{{1.0f, 0.5f, 0.0f}}}, ScanPose());
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fiimap::fuzz::TemporaryInput file("configuration.yaml");
  file.write(data, size);
  try {
    fiimap::fuzz::configureFrom(file.path());
  } catch (const std::invalid_argument& error) {
    fiimap::fuzz::require(error.what()[0] != '\0', "refused without a word");
  }
  return 0;
}
