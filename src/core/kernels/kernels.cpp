#include "fiimap/kernels.h"

#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace fiimap {
namespace {

const Kernels& chosenKernels() {
  const std::vector<const Kernels*> available = availableKernels();
  const char* const wanted = std::getenv("FIIMAP_SIMD");
  if (wanted == nullptr || *wanted == '\0') return *available.front();
  std::string names;
  for (const Kernels* kernels : available) {
    if (std::string(kernels->name) == wanted) return *kernels;
    names += std::string(names.empty() ? "" : ", ") + kernels->name;
  }
  throw std::runtime_error("FIIMAP_SIMD is " + std::string(wanted) +
                           ", this machine has: " + names);
}

}  // namespace

void RayEnds::begin(int count) {
  size = 0;
  low[0] = low[1] = std::numeric_limits<std::int32_t>::max();
  high[0] = high[1] = -1;
  const std::size_t room = static_cast<std::size_t>(count) + kVectorRoom;
  if (x.size() >= room) return;
  for (auto* list : {&x, &y, &z, &first}) list->resize(room);
}

void CubeRays::reserve(int count) {
  const std::size_t room = static_cast<std::size_t>(count) + kVectorRoom;
  if (slice.size() >= room) return;
  slice.resize(room);
  cell.resize(room);
  reach.resize(room);
}

void ColumnWalk::reserve(int slabs) {
  const std::size_t room = static_cast<std::size_t>(2) * slabs + 1 + kVectorRoom;
  if (column.size() >= room) return;
  column.resize(room);
  t.resize(room);
  first_of_slab.resize(room);
}

const Kernels& kernels() {
  static const Kernels& chosen = chosenKernels();
  return chosen;
}

}  // namespace fiimap
