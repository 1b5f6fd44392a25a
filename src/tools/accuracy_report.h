#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scan_prediction.h"

namespace fiimap {

/// Figures of one kind of map (method, variant and resolution) over the held-out scans of all
/// folds; each is the mean over scans of the share of a scan's rays.
struct AccuracyRow {
  std::string method;       ///< which map: fiimap or octomap
  std::string variant;      ///< final_map or online
  double resolution = 0.0;  ///< m
  std::size_t held_out_scans = 0;
  double hit_rate_mean = 0.0;
  double hit_rate_std = 0.0;  ///< over scans, of the population
  double hit_rate_within_one_voxel_mean = 0.0;
  double blocked_rate_mean = 0.0;
  double outside_rate_mean = 0.0;
};

/// Scans without any return do not count.
AccuracyRow summarise(const std::string& method, const std::string& variant, double resolution,
                      const std::vector<ScanPrediction>& scans);

/// Keys are the names of the fields.
nlohmann::json toJson(const AccuracyRow& row);
/// The table for people, or as CSV.
std::string toText(const std::vector<AccuracyRow>& rows, bool csv);

}  // namespace fiimap
