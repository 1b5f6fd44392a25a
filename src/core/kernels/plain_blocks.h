#pragma once

#include <algorithm>

namespace fiimap::plain {

/// Long enough that compilers keep loops over it, which they vectorize, instead of unrolling them.
constexpr int kBlock = 32;
constexpr int kGroup = 8;  ///< that are mostly alike

inline float clamp(float value, float low, float high) {
  return std::min(std::max(value, low), high);
}

}  // namespace fiimap::plain
