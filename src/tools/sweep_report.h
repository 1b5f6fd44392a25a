#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "quantiles.h"

namespace fiimap {

/// What one way to inflate cost per update, CPU time of the thread.
struct SweepRow {
  double resolution = 0.0;  ///< m
  std::string shape;
  int reach = 0;  ///< L, voxels
  std::string method;
  std::size_t updates = 0;  ///< measured; fewer than there are when its time was up
  Quantiles time_us;
};

/// Keys as documented in docs/evaluation.md.
nlohmann::json toJson(const SweepRow& row);
/// The table for people, or as CSV.
std::string toText(const std::vector<SweepRow>& rows, bool csv);

}  // namespace fiimap
