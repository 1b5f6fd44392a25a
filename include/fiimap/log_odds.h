#pragma once

#include <cstdint>

#include "fiimap/mapper_config.h"

namespace fiimap {

/// The paper's Bayes update (eq. 6-8) in 8-bit fixed point: the largest of |L_min|, |L_max|, hit
/// and |miss| is 127 units, so that a voxel's state is one byte and saturating byte arithmetic is
/// exact. The prior is 0.5, log-odds 0. Immutable, safe to share between threads.
struct LogOdds {
  /// \param config validated probabilities p_hit, p_miss, p_min, p_max, p_occ.
  explicit LogOdds(const MapperConfig& config);

  double unit;            ///< log-odds of one step
  std::int8_t hit;        ///< > 0, added by a hit
  std::int8_t miss;       ///< < 0, added by a miss
  std::int8_t min;        ///< L_min
  std::int8_t max;        ///< L_max
  std::int8_t threshold;  ///< occupied from here on

  /// Steps of another scale in this one: the nearest to the same log-odds within L_min and L_max.
  std::int8_t convert(std::int8_t steps, const LogOdds& other) const;
  /// Whether both scales and steps are the same.
  bool operator==(const LogOdds& other) const;

  /// Scans that must hit an unknown voxel until it is occupied.
  int hitsToOccupy() const;
  /// Scans that must see through a voxel of the highest certainty until it is free.
  int missesToClear() const;
};

}  // namespace fiimap
