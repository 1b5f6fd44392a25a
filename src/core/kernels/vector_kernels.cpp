// Compiled once for each instruction set that Highway knows for this processor family.
//
// Not for SVE, whose vectors have no size known to the compiler: they cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <cstdint>
#include <vector>

#include "target_kernels.h"

// Without vectors the plain kernels do.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#include "vector_depth_kernels.h"
#include "vector_end_kernels.h"
#include "vector_fusion_kernels.h"
#include "vector_inflation_kernels.h"
#include "vector_ray_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace fiimap {
namespace HWY_NAMESPACE {

const TargetKernels kTargetKernels{
    HWY_TARGET,
    {nullptr, readDepths, projectRow, listEnds, selectEnds, roundRays, walk, freeRuns, observe,
     widen, dilate, replace, replaceRows, add}};

}  // namespace HWY_NAMESPACE
}  // namespace fiimap
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace fiimap {
namespace {

/// Those of the machine, best first. Of a machine for which Highway has no vectors, or only those
/// that the compiler uses for plain C++: none.
std::vector<Kernels> vectorKernels() {
  const TargetKernels* const all[] = {HWY_CHOOSE_TARGET_LIST(kTargetKernels)};
  std::vector<Kernels> supported;
  for (const auto* of_target : all) {
    if (of_target == nullptr || (of_target->target & hwy::SupportedTargets()) == 0) continue;
    supported.push_back(of_target->kernels);
    supported.back().name = hwy::TargetName(of_target->target);
  }
  return supported;
}

}  // namespace

std::vector<const Kernels*> availableKernels() {
  static const std::vector<Kernels> vectors = vectorKernels();
  std::vector<const Kernels*> available;
  for (const Kernels& kernels : vectors) available.push_back(&kernels);
  available.push_back(&plainKernels());
  return available;
}

}  // namespace fiimap
#endif  // HWY_ONCE
