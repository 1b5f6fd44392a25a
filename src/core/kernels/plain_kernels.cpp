#include "fiimap/kernels.h"
#include "plain_depth_kernels.h"
#include "plain_end_kernels.h"
#include "plain_fusion_kernels.h"
#include "plain_inflation_kernels.h"
#include "plain_ray_kernels.h"

namespace fiimap {

const Kernels& plainKernels() {
  static const Kernels kernels{
      "plain",          plain::readDepths, plain::projectRow,  plain::listEnds, plain::selectEnds,
      plain::roundRays, plain::walk,       plain::freeRuns,    plain::observe,  plain::widen,
      plain::dilate,    plain::replace,    plain::replaceRows, plain::add};
  return kernels;
}

}  // namespace fiimap
