#include "fiimap/kernels.h"

namespace fiimap {

std::vector<const Kernels*> availableKernels() { return {&plainKernels()}; }

}  // namespace fiimap
