#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace fiimap::sim {

/// What really happened to the vehicle. A collision begins when the clearance falls below the
/// radius, and counts again only after the vehicle was clear of everything.
struct FlightRecord {
  double clearance = std::numeric_limits<double>::infinity();  ///< centre to nearest surface, m
  double least_clearance = std::numeric_limits<double>::infinity();  ///< since the start, m
  std::uint64_t collisions = 0;
  double path_length = 0.0;  ///< m

  /// \param way flown since the last time, m; \param radius of the vehicle, m.
  void add(double new_clearance, double way, double radius) {
    const bool was_clear = clearance >= radius;
    if (was_clear && new_clearance < radius) ++collisions;
    clearance = new_clearance;
    if (clearance < least_clearance) least_clearance = clearance;
    path_length += way;
  }
};

}  // namespace fiimap::sim
