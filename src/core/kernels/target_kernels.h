#pragma once

#include <cstdint>

#include "fiimap/kernels.h"

namespace fiimap {

/// The kernels for one instruction set, with the bit that Highway has for it.
struct TargetKernels {
  std::int64_t target;
  Kernels kernels;
};

}  // namespace fiimap
