#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fiimap/mapper.h"
#include "fiimap/ros/scan_counters.h"

namespace fiimap {

/// Figures of one run over a bag: what each scan cost and changed, and what the map is in the end.
class RunReport {
 public:
  /// Adds one integrated scan.
  void add(const ScanReport& scan);
  /// Adds one comparison with brute force.
  void addVerification(std::int64_t mismatches);
  /// Takes over what is known only at the end.
  void finish(const ScanCounters& counters, const Snapshot& snapshot, std::size_t memory_bytes);

  std::int64_t mismatches() const { return mismatches_; }
  /// Keys as documented in README.md.
  nlohmann::json json() const;
  /// The same for people.
  std::string text() const;

 private:
  std::vector<ScanReport> scans_;
  ScanCounters counters_;
  std::int64_t verified_ = 0;
  std::int64_t mismatches_ = 0;
  std::int64_t occupied_ = 0;
  std::int64_t inflated_ = 0;
  std::int64_t window_voxels_ = 1;
  std::size_t memory_bytes_ = 0;
};

}  // namespace fiimap
