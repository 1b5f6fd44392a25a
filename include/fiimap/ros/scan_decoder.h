#pragma once

#include "fiimap/mapper.h"
#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap {

/// Decodes synchronised scans and integrates them into a mapper. Not thread-safe (keeps memory).
class ScanDecoder {
 public:
  /// \throws InputError, with the map unchanged, when the message or its pose cannot be used.
  ScanReport integrate(const SynchronizedScan& scan, Mapper* mapper);

  /// Wall-clock time that decoding the last scan took, ms; not part of the report's times.
  double decodeTimeMs() const { return decode_time_ms_; }

 private:
  double decode_time_ms_ = 0.0;
  PointScan points_;
};

}  // namespace fiimap
