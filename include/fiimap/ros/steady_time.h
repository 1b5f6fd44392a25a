#pragma once

#include <chrono>

namespace fiimap {

using SteadyTime = std::chrono::steady_clock::time_point;

inline double secondsBetween(SteadyTime from, SteadyTime to) {
  return std::chrono::duration<double>(to - from).count();
}

inline double millisecondsSince(SteadyTime start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace fiimap
