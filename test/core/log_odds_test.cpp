#include "fiimap/log_odds.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

double logit(double p) { return std::log(p / (1.0 - p)); }

/// Probabilities anywhere in their ranges, as validate() wants them.
MapperConfig randomProbabilities(test::Random& random) {
  MapperConfig config;
  config.p_hit = test::uniformReal(random, 0.501, 0.999);
  config.p_miss = test::uniformReal(random, 0.002, 0.499);
  config.p_min = test::uniformReal(random, 0.001, config.p_miss - 1e-6);
  config.p_max = test::uniformReal(random, 0.502, 0.999);
  config.p_occ = test::uniformReal(random, 0.501, config.p_max - 1e-6);
  return config;
}

/// Where the fixed-point value can be if each constant is off by at most half a unit, or by a whole
/// unit where a hit or a miss would otherwise do nothing; and what eq. 6-8 give.
class FloatReference {
 public:
  FloatReference(const MapperConfig& config, double unit)
      : half_unit_(0.5 * unit),
        hit_(logit(config.p_hit)),
        miss_(logit(config.p_miss)),
        min_(logit(config.p_min)),
        max_(logit(config.p_max)) {}

  void observe(bool is_hit) {
    const double step = is_hit ? hit_ : miss_;
    const double error = std::abs(step) < half_unit_ ? 2.0 * half_unit_ : half_unit_;
    value_ = std::clamp(value_ + step, min_, max_);
    low_ = std::clamp(low_ + step - error, min_ - half_unit_, max_ - half_unit_);
    high_ = std::clamp(high_ + step + error, min_ + half_unit_, max_ + half_unit_);
  }

  double value() const { return value_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double half_unit_, hit_, miss_, min_, max_;
  double value_ = 0.0, low_ = 0.0, high_ = 0.0;
};

int observe(const LogOdds& log_odds, int value, bool is_hit) {
  return std::clamp<int>(value + (is_hit ? log_odds.hit : log_odds.miss), log_odds.min,
                         log_odds.max);
}

TEST(LogOddsTest, LargestConstantIs127Units) {
  test::Random random(31);
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE("seed 31, round " + std::to_string(round));
    const MapperConfig c = randomProbabilities(random);
    const LogOdds log_odds(c);
    const double largest =
        std::max({logit(c.p_hit), -logit(c.p_miss), -logit(c.p_min), logit(c.p_max)});
    ASSERT_NEAR(log_odds.unit * 127, largest, 1e-9);
    const int largest_units = std::max({std::abs<int>(log_odds.hit), std::abs<int>(log_odds.miss),
                                        std::abs<int>(log_odds.min), std::abs<int>(log_odds.max)});
    ASSERT_EQ(largest_units, 127);
  }
}

TEST(LogOddsTest, ConstantsHaveTheirSigns) {
  test::Random random(32);
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE("seed 32, round " + std::to_string(round));
    const LogOdds log_odds(randomProbabilities(random));
    ASSERT_GT(log_odds.hit, 0);
    ASSERT_LT(log_odds.miss, 0);
    ASSERT_LE(log_odds.min, 0);
    ASSERT_GT(log_odds.max, 0);
    // An unknown voxel is not occupied, and a voxel of the highest certainty is.
    ASSERT_GT(log_odds.threshold, 0);
    ASSERT_LE(log_odds.threshold, log_odds.max);
  }
}

TEST(LogOddsTest, FixedPointFollowsFloatingPoint) {
  test::Random random(33);
  for (int round = 0; round < 2000; ++round) {
    SCOPED_TRACE("seed 33, round " + std::to_string(round));
    const MapperConfig config = randomProbabilities(random);
    const LogOdds log_odds(config);
    FloatReference reference(config, log_odds.unit);
    const double hit_share = test::uniformReal(random, 0.0, 1.0);
    int value = 0;
    for (int scan = 0; scan < 60; ++scan) {
      const bool is_hit = test::chance(random, hit_share);
      value = observe(log_odds, value, is_hit);
      reference.observe(is_hit);
      constexpr double kRounding = 1e-9;
      ASSERT_GE(value * log_odds.unit, reference.low() - kRounding) << "scan " << scan;
      ASSERT_LE(value * log_odds.unit, reference.high() + kRounding) << "scan " << scan;
    }
  }
}

TEST(LogOddsTest, ClassifiesAsFloatingPointAwayFromTheThreshold) {
  test::Random random(34);
  int decided = 0, close = 0;
  for (int round = 0; round < 2000; ++round) {
    SCOPED_TRACE("seed 34, round " + std::to_string(round));
    const MapperConfig config = randomProbabilities(random);
    const LogOdds log_odds(config);
    FloatReference reference(config, log_odds.unit);
    const double threshold = logit(config.p_occ);
    int value = 0;
    for (int scan = 0; scan < 30; ++scan) {
      const bool is_hit = test::chance(random, 0.5);
      value = observe(log_odds, value, is_hit);
      reference.observe(is_hit);
      // The threshold is rounded too, and is at least one unit.
      const double bound =
          std::max(reference.high() - reference.value(), reference.value() - reference.low()) +
          log_odds.unit;
      if (std::abs(reference.value() - threshold) <= bound) {
        ++close;
        continue;
      }
      ++decided;
      ASSERT_EQ(value >= log_odds.threshold, reference.value() >= threshold) << "scan " << scan;
    }
  }
  EXPECT_GT(decided, 3 * close) << "the test decides too rarely";
}

TEST(LogOddsTest, ClampedValuesFitOneByte) {
  test::Random random(35);
  for (int round = 0; round < 500; ++round) {
    const LogOdds log_odds(randomProbabilities(random));
    // Saturating byte arithmetic must be enough before clamping.
    EXPECT_GE(log_odds.min, -127) << "seed 35";
    EXPECT_LE(log_odds.max, 127) << "seed 35";
    EXPECT_GE(log_odds.miss, -127) << "seed 35";
    EXPECT_LE(log_odds.hit, 127) << "seed 35";
  }
}

TEST(LogOddsTest, HitsToOccupyAgreesWithSimulation) {
  test::Random random(36);
  for (int round = 0; round < 1000; ++round) {
    const LogOdds log_odds(randomProbabilities(random));
    int hits = 0;
    for (int value = 0; value < log_odds.threshold; ++hits) value = observe(log_odds, value, true);
    ASSERT_EQ(log_odds.hitsToOccupy(), hits) << "seed 36, round " << round;
  }
}

TEST(LogOddsTest, MissesToClearAgreesWithSimulation) {
  test::Random random(37);
  for (int round = 0; round < 1000; ++round) {
    const LogOdds log_odds(randomProbabilities(random));
    int misses = 0;
    for (int value = log_odds.max; value >= log_odds.threshold; ++misses) {
      value = observe(log_odds, value, false);
    }
    ASSERT_EQ(log_odds.missesToClear(), misses) << "seed 37, round " << round;
  }
}

TEST(LogOddsTest, DefaultsNeedThreeHitsAndThreeMisses) {
  // logit(.65) = .619, logit(.30) = -.847, logit(.80) = 1.386, logit(.97) = 3.476.
  const LogOdds log_odds{MapperConfig()};
  EXPECT_EQ(log_odds.hitsToOccupy(), 3);
  EXPECT_EQ(log_odds.missesToClear(), 3);
}

TEST(LogOddsTest, ConvertsToTheNearestStepWithinTheLimits) {
  test::Random random(31);
  for (int round = 0; round < 300; ++round) {
    const LogOdds from(randomProbabilities(random)), to(randomProbabilities(random));
    for (int steps = from.min; steps <= from.max; ++steps) {
      const double log_odds = steps * from.unit;
      const int converted = to.convert(static_cast<std::int8_t>(steps), from);
      ASSERT_GE(converted, to.min);
      ASSERT_LE(converted, to.max);
      const double error = std::abs(converted * to.unit - log_odds);
      for (const int other : {converted - 1, converted + 1}) {
        if (other < to.min || other > to.max) continue;
        ASSERT_LE(error, std::abs(other * to.unit - log_odds) + 1e-12) << "round " << round;
      }
    }
  }
}

TEST(LogOddsTest, ConvertsToItselfWhereOnlyTheThresholdOrALimitDiffers) {
  MapperConfig config;
  const LogOdds from(config);
  config.p_occ = 0.6;
  config.p_min = 0.2;
  const LogOdds to(config);
  EXPECT_FALSE(from == to);
  EXPECT_TRUE(from == LogOdds(MapperConfig()));
  for (int steps = from.min; steps <= from.max; ++steps) {
    const int converted = to.convert(static_cast<std::int8_t>(steps), from);
    EXPECT_EQ(converted, std::max<int>(steps, to.min));
  }
}

}  // namespace
}  // namespace fiimap
