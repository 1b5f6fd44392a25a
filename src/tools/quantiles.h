#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fiimap {

/// Nearest-rank quantiles; zero where there are no values.
struct Quantiles {
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

inline Quantiles quantilesOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * values.size()));
    return values[std::max<std::size_t>(rank, 1) - 1];
  };
  constexpr double kMedian = 0.5, kP95 = 0.95;
  return {at(kMedian), at(kP95), values.back()};
}

}  // namespace fiimap
