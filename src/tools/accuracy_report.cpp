#include "accuracy_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fiimap {
namespace {

struct MeanAndDeviation {
  double mean = 0.0;
  double deviation = 0.0;
};

MeanAndDeviation shareOfRays(const std::vector<ScanPrediction>& scans,
                             std::size_t ScanPrediction::*part) {
  double sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (const ScanPrediction& scan : scans) {
    if (scan.rays == 0) continue;
    const double share = static_cast<double>(scan.*part) / scan.rays;
    sum += share;
    squares += share * share;
    ++count;
  }
  if (count == 0) return {};
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

}  // namespace

AccuracyRow summarise(const std::string& method, const std::string& variant, double resolution,
                      const std::vector<ScanPrediction>& scans) {
  AccuracyRow row;
  row.method = method;
  row.variant = variant;
  row.resolution = resolution;
  for (const ScanPrediction& scan : scans) row.held_out_scans += scan.rays > 0 ? 1 : 0;
  const MeanAndDeviation hits = shareOfRays(scans, &ScanPrediction::hits);
  row.hit_rate_mean = hits.mean;
  row.hit_rate_std = hits.deviation;
  row.hit_rate_within_one_voxel_mean = shareOfRays(scans, &ScanPrediction::near).mean;
  row.blocked_rate_mean = shareOfRays(scans, &ScanPrediction::blocked).mean;
  row.outside_rate_mean = shareOfRays(scans, &ScanPrediction::outside).mean;
  return row;
}

nlohmann::json toJson(const AccuracyRow& row) {
  return {
      {"method", row.method},
      {"variant", row.variant},
      {"resolution", row.resolution},
      {"held_out_scans", row.held_out_scans},
      {"hit_rate_mean", row.hit_rate_mean},
      {"hit_rate_std", row.hit_rate_std},
      {"hit_rate_within_one_voxel_mean", row.hit_rate_within_one_voxel_mean},
      {"blocked_rate_mean", row.blocked_rate_mean},
      {"outside_rate_mean", row.outside_rate_mean},
  };
}

std::string toText(const std::vector<AccuracyRow>& rows, bool csv) {
  std::string text = csv ? "method,variant,resolution,held_out_scans,hit_rate_mean,hit_rate_std,"
                           "hit_rate_within_one_voxel_mean,blocked_rate_mean,outside_rate_mean\n"
                         : "method   variant     resolution  scans      hit     +-  within 1 voxel "
                           " blocked  outside\n";
  const char* format = csv ? "%s,%s,%g,%zu,%.6f,%.6f,%.6f,%.6f,%.6f\n"
                           : "%-8s %-10s %9g m %6zu    %.4f  %.3f          %.4f   %.4f   %.4f\n";
  for (const AccuracyRow& row : rows) {
    char line[160];
    std::snprintf(line, sizeof(line), format, row.method.c_str(), row.variant.c_str(),
                  row.resolution, row.held_out_scans, row.hit_rate_mean, row.hit_rate_std,
                  row.hit_rate_within_one_voxel_mean, row.blocked_rate_mean, row.outside_rate_mean);
    text += line;
  }
  return text;
}

}  // namespace fiimap
