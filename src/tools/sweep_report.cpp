#include "sweep_report.h"

#include <cstdio>

namespace fiimap {

nlohmann::json toJson(const SweepRow& row) {
  return {
      {"resolution", row.resolution}, {"shape", row.shape},
      {"reach", row.reach},           {"method", row.method},
      {"updates", row.updates},       {"median_us", row.time_us.median},
      {"p95_us", row.time_us.p95},    {"max_us", row.time_us.max},
  };
}

std::string toText(const std::vector<SweepRow>& rows, bool csv) {
  std::string text = csv ? "resolution,shape,reach,method,updates,median_us,p95_us,max_us\n"
                         : "resolution  shape     L  method       updates   median us      p95 us"
                           "      max us\n";
  const char* format = csv ? "%g,%s,%d,%s,%zu,%.3f,%.3f,%.3f\n"
                           : "%8g m  %-7s %3d  %-11s %8zu %11.1f %11.1f %11.1f\n";
  for (const SweepRow& row : rows) {
    char line[160];
    std::snprintf(line, sizeof(line), format, row.resolution, row.shape.c_str(), row.reach,
                  row.method.c_str(), row.updates, row.time_us.median, row.time_us.p95,
                  row.time_us.max);
    text += line;
  }
  return text;
}

}  // namespace fiimap
