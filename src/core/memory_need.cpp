#include "memory_need.h"

#include <unistd.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "fiimap/scan_mask.h"
#include "fiimap/sliding_grid.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {
namespace {

constexpr double kMegabyte = 1e6;

double machineMemory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::string megabytes(double bytes) {
  return std::to_string(static_cast<std::int64_t>(bytes / kMegabyte)) + " MB";
}

VoxelIndex windowSize(const MapperConfig& config) {
  return VoxelLattice(config.resolution).sizeOf(config.mapSize());
}

VoxelIndex updateSize(const MapperConfig& config) {
  const VoxelIndex range = VoxelLattice(config.resolution).sizeOf(config.localUpdateRange());
  return range.cwiseMin(windowSize(config));
}

}  // namespace

double memoryNeed(const MapperConfig& config) {
  const bool keeps_seen = config.decay_time > 0.0;
  return static_cast<double>(SlidingGrid::worstCaseMemoryBytes(windowSize(config), keeps_seen)) +
         static_cast<double>(ScanMask::memoryBytes(updateSize(config)));
}

void requireMemory(const MapperConfig& config) {
  const std::string sizes = "map_size_x/y/z, local_update_range_x/y/z and resolution";
  const double need = memoryNeed(config);
  const bool limited = config.memory_limit > 0.0;
  const double available = limited ? config.memory_limit * kMegabyte : machineMemory();
  if (need > available) {
    throw std::invalid_argument(
        "parameters " + sizes + ": the map needs " + megabytes(need) + " when all is seen, " +
        megabytes(available) + " are available (" +
        (limited ? "memory_limit" : "the machine's memory; memory_limit allows more") +
        "); make the map smaller or its voxels larger");
  }
  if (ScanMask::words(updateSize(config)) > std::numeric_limits<std::int32_t>::max()) {
    throw std::invalid_argument("parameters local_update_range_x/y/z and resolution: a scan over " +
                                std::to_string(ScanMask::words(updateSize(config))) +
                                " words of 64 voxels, must be at most 2^31 - 1");
  }
}

}  // namespace fiimap
