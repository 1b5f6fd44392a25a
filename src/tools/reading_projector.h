#pragma once

#include <vector>

#include "fiimap/mapper_config.h"
#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap {

/// The readings of scans in the world frame, as the map takes them in: same ranges and margins,
/// with a pixel step of its own. Not thread-safe (keeps memory).
class ReadingProjector {
 public:
  /// \param pixel_step use every n-th pixel of every n-th row, of organised clouds too; >= 1.
  ReadingProjector(const MapperConfig& config, int pixel_step);

  /// Fills `range` anew.
  /// \return how many readings were of which kind. \throws InputError when the message cannot be
  /// used.
  ReadingCount project(const SynchronizedScan& scan, RangeData* range);

 private:
  struct Projectors {
    DepthProjector depth;
    PointProjector points;
  };

  int pixel_step_;
  std::vector<Projectors> projectors_;  // by sensor
  PointScan points_;
};

}  // namespace fiimap
