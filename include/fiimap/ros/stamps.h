#pragma once

#include <ros/time.h>

#include <cstdint>

namespace fiimap {

/// Seconds from one stamp to another, negative when `to` is earlier. Unlike ros::Duration it does
/// not throw for stamps that are decades apart, as those of misconfigured drivers are.
inline double secondsBetween(const ros::Time& from, const ros::Time& to) {
  constexpr double kNanosecondsPerSecond = 1e9;
  return static_cast<double>(static_cast<std::int64_t>(to.toNSec()) -
                             static_cast<std::int64_t>(from.toNSec())) /
         kNanosecondsPerSecond;
}

}  // namespace fiimap
