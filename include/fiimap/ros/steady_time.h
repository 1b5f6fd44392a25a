#pragma once

#include <chrono>

namespace fiimap {

/// A moment of the clock that nobody sets.
using SteadyTime = std::chrono::steady_clock::time_point;

/// Seconds from one moment to another.
inline double secondsBetween(SteadyTime from, SteadyTime to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Milliseconds from a moment to now.
inline double millisecondsSince(SteadyTime start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace fiimap
