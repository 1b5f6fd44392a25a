#include "fiimap/log_odds.h"

#include <algorithm>
#include <cmath>

namespace fiimap {
namespace {

constexpr int kLargestByte = 127;

double logOdds(double p) { return std::log(p / (1.0 - p)); }

std::int8_t quantise(double log_odds, double unit) {
  return static_cast<std::int8_t>(std::lround(log_odds / unit));
}

}  // namespace

LogOdds::LogOdds(const MapperConfig& config) {
  const double l_hit = logOdds(config.p_hit);
  const double l_miss = logOdds(config.p_miss);
  const double l_min = logOdds(config.p_min);
  const double l_max = logOdds(config.p_max);
  unit = std::max({l_hit, -l_miss, -l_min, l_max}) / kLargestByte;
  // Every observation must do something, however fine its probability.
  hit = std::max<std::int8_t>(1, quantise(l_hit, unit));
  miss = std::min<std::int8_t>(-1, quantise(l_miss, unit));
  min = quantise(l_min, unit);
  max = quantise(l_max, unit);
  threshold = std::min(max, std::max<std::int8_t>(1, quantise(logOdds(config.p_occ), unit)));
}

std::int8_t LogOdds::convert(std::int8_t steps, const LogOdds& other) const {
  const long nearest = std::lround(steps * other.unit / unit);
  return static_cast<std::int8_t>(std::clamp<long>(nearest, min, max));
}

bool LogOdds::operator==(const LogOdds& other) const {
  return unit == other.unit && hit == other.hit && miss == other.miss && min == other.min &&
         max == other.max && threshold == other.threshold;
}

int LogOdds::hitsToOccupy() const { return (threshold + hit - 1) / hit; }

int LogOdds::missesToClear() const { return (max - threshold) / -miss + 1; }

}  // namespace fiimap
