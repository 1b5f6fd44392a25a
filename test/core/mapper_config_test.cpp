#include "fiimap/mapper_config.h"

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fiimap/parameters.h"
#include "refusal.h"

namespace fiimap {
namespace {

/// A parameter, a value unlike its default, and whether a configuration has that value.
struct FieldOfParameter {
  std::string name;
  std::string text;
  std::function<bool(const MapperConfig&)> has_value;
  double MapperConfig::*number = nullptr;  ///< null where the field is no double
};

FieldOfParameter number(const std::string& name, double MapperConfig::*field, double value) {
  return {name, std::to_string(value),
          [=](const MapperConfig& c) { return std::abs(c.*field - value) < 1e-9; }, field};
}

/// \tparam Struct the configuration or a part of it.
template <typename Struct, typename T>
FieldOfParameter choice(const std::string& name, T Struct::*field, const std::string& text,
                        T value) {
  return {name, text, [=](const MapperConfig& c) { return c.*field == value; }, nullptr};
}

std::vector<FieldOfParameter> fields() {
  using C = MapperConfig;
  return {
      number("resolution", &C::resolution, 0.125),
      choice("map_mode", &C::map_mode, "fixed", MapMode::kFixed),
      number("map_size_x", &C::map_size_x, 41.0),
      number("map_size_y", &C::map_size_y, 42.0),
      number("map_size_z", &C::map_size_z, 5.0),
      number("map_center_x", &C::map_center_x, -1.25),
      number("map_center_y", &C::map_center_y, -2.25),
      number("map_center_z", &C::map_center_z, -3.25),
      number("slide_distance", &C::slide_distance, 0.75),
      number("local_update_range_x", &C::local_update_range_x, 11.0),
      number("local_update_range_y", &C::local_update_range_y, 12.0),
      number("local_update_range_z", &C::local_update_range_z, 4.0),
      number("memory_limit", &C::memory_limit, 4096.0),
      number("depth_scale", &C::depth_scale, 0.0002),
      number("min_depth", &C::min_depth, 0.45),
      number("max_depth", &C::max_depth, 6.5),
      choice("pixel_step", &C::pixel_step, "3", 3),
      choice("border_margin", &C::border_margin, "7", 7),
      choice("invalid_depth", &C::invalid_depth, "free", ReadingPolicy::kFree),
      choice("infinite_depth", &C::infinite_depth, "ignore", ReadingPolicy::kIgnore),
      choice("beyond_max_depth", &C::beyond_max_depth, "ignore", ReadingPolicy::kIgnore),
      number("min_ray_length", &C::min_ray_length, 0.55),
      number("max_ray_length", &C::max_ray_length, 7.5),
      number("ray_end_cut", &C::ray_end_cut, 0.5),
      number("min_hit_cover", &C::min_hit_cover, 0.2),
      choice("round_rays", &C::round_rays, "false", false),
      number("body_size_x", &C::body_size_x, 0.7),
      number("body_size_y", &C::body_size_y, 0.6),
      number("body_size_z", &C::body_size_z, 0.3),
      number("decay_time", &C::decay_time, 12.5),
      choice("clear_body", &C::clear_body, "true", true),
      number("p_hit", &C::p_hit, 0.60),
      number("p_miss", &C::p_miss, 0.45),
      number("p_min", &C::p_min, 0.2),
      number("p_max", &C::p_max, 0.9),
      number("p_occ", &C::p_occ, 0.75),
      number("inflation_radius", &C::inflation_radius, 0.35),
      choice("inflation_shape", &C::inflation_shape, "diamond", ElementShape::kDiamond),
      choice("inflation_method", &C::inflation_method, "bfs", InflationMethod::kBfs),
      choice("bfs_connectivity", &C::bfs_connectivity, "26", 26),
      choice("virtual_walls", &C::virtual_walls, "true", true),
      number("virtual_floor", &C::virtual_floor, -0.5),
      number("virtual_ceiling", &C::virtual_ceiling, 2.5),
  };
}

std::string refusal(const MapperConfig& config) {
  try {
    config.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MapperParametersTest, HasExactlyTheKnownNames) {
  MapperConfig config;
  std::set<std::string> expected, actual;
  for (const FieldOfParameter& field : fields()) expected.insert(field.name);
  for (const Parameter& parameter : mapperParameters(&config)) {
    EXPECT_TRUE(actual.insert(parameter.name).second) << parameter.name << " twice";
    EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
    EXPECT_FALSE(parameter.allowed.empty()) << parameter.name;
  }
  EXPECT_EQ(actual, expected);
}

TEST(MapperParametersTest, EachSetsItsOwnFieldAndNoOther) {
  for (const FieldOfParameter& field : fields()) {
    SCOPED_TRACE(field.name);
    MapperConfig config;
    ASSERT_FALSE(field.has_value(config)) << "the value is the default";
    EXPECT_TRUE(applyParameters({{field.name, field.text}}, mapperParameters(&config)).empty());
    for (const FieldOfParameter& other : fields()) {
      EXPECT_EQ(other.has_value(config), other.name == field.name) << other.name;
    }
  }
}

/// The ends of "... in [low, high] ..."; empty where a parameter allows something else.
std::vector<std::string> rangeOf(const std::string& allowed) {
  const std::size_t open = allowed.find('['), comma = allowed.find(", ", open),
                    close = allowed.find(']');
  if (open == std::string::npos || comma > close) return {};
  return {allowed.substr(open + 1, comma - open - 1), allowed.substr(comma + 2, close - comma - 2)};
}

TEST(MapperParametersTest, RangesAreEnforcedAsDescribed) {
  MapperConfig config;
  int numeric = 0;
  for (const Parameter& parameter : mapperParameters(&config)) {
    SCOPED_TRACE(parameter.name);
    const std::vector<std::string> ends = rangeOf(parameter.allowed);
    if (ends.empty()) continue;
    ++numeric;
    const double low = std::stod(ends[0]), high = std::stod(ends[1]);
    EXPECT_EQ(refusal(parameter, ends[0]), "");
    EXPECT_EQ(refusal(parameter, ends[1]), "");
    const std::string in_range = parameter.get();
    for (const double bad : {low - 1e-5 - std::abs(low) * 1e-5, low - 1.0,
                             high + 1e-5 + std::abs(high) * 1e-5, high + 1.0}) {
      const std::string text = std::to_string(bad);
      const std::string message = refusal(parameter, text);
      EXPECT_TRUE(contains(message, parameter.name)) << message;
      EXPECT_TRUE(contains(message, text)) << message;
      EXPECT_TRUE(contains(message, parameter.allowed)) << message;
    }
    EXPECT_EQ(parameter.get(), in_range);
  }
  EXPECT_EQ(numeric, 33) << "numeric parameters whose description names no range";
}

TEST(MapperParametersTest, RefuseTheWrongType) {
  MapperConfig config;
  for (const Parameter& parameter : mapperParameters(&config)) {
    for (const char* text : {"", "wrong", "[1, 2]", "nan"}) {
      const std::string message = refusal(parameter, text);
      EXPECT_TRUE(contains(message, parameter.name)) << parameter.name << " takes " << text;
      EXPECT_TRUE(contains(message, parameter.allowed)) << message;
    }
  }
}

TEST(MapperParametersTest, UnknownKeysComeBackByName) {
  MapperConfig config;
  EXPECT_EQ(
      applyParameters({{"resolutoin", "0.2"}, {"resolution", "0.2"}}, mapperParameters(&config)),
      std::vector<std::string>{"resolutoin"});
  EXPECT_DOUBLE_EQ(config.resolution, 0.2);
}

TEST(MapperConfigTest, DefaultsAreValid) { EXPECT_EQ(refusal(MapperConfig()), ""); }

TEST(MapperConfigTest, ValidateRefusesNumbersThatAreNotFinite) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  int numbers = 0;
  for (const FieldOfParameter& field : fields()) {
    if (field.number == nullptr) continue;
    ++numbers;
    for (const double bad : {kNan, kInf, -kInf}) {
      MapperConfig config;
      config.*field.number = bad;
      EXPECT_TRUE(contains(refusal(config), field.name)) << field.name << " = " << bad;
    }
  }
  EXPECT_EQ(numbers, 31);
}

TEST(MapperConfigTest, ValidateRefusesNumbersOutOfRange) {
  for (const FieldOfParameter& field : fields()) {
    if (field.number == nullptr) continue;
    for (const double bad : {1e30, -1e30}) {
      MapperConfig config;
      config.*field.number = bad;
      EXPECT_TRUE(contains(refusal(config), field.name)) << field.name << " = " << bad;
    }
  }
  MapperConfig config;
  config.pixel_step = -1;
  EXPECT_TRUE(contains(refusal(config), "pixel_step"));
  config = {};
  config.border_margin = -1;
  EXPECT_TRUE(contains(refusal(config), "border_margin"));
}

TEST(MapperConfigTest, ValidateLeavesTheConfigurationAlone) {
  MapperConfig config;
  config.map_size_x = 1.0 / 3.0 + 20.0;
  const double before = config.map_size_x;
  config.validate();
  EXPECT_EQ(config.map_size_x, before);
}

/// Expects that a change to the defaults is refused with all of these words.
void expectRefused(const std::function<void(MapperConfig*)>& change,
                   const std::vector<std::string>& words) {
  MapperConfig config;
  change(&config);
  const std::string message = refusal(config);
  for (const std::string& word : words) {
    EXPECT_TRUE(contains(message, word)) << "'" << message << "' lacks " << word;
  }
}

void expectAccepted(const std::function<void(MapperConfig*)>& change) {
  MapperConfig config;
  change(&config);
  EXPECT_EQ(refusal(config), "");
}

TEST(MapperConfigTest, LimitsOfDepthAndRayLengthMustNotCross) {
  expectRefused([](MapperConfig* c) { c->min_depth = 9.0; }, {"min_depth", "9", "max_depth"});
  expectRefused([](MapperConfig* c) { c->min_depth = c->max_depth; }, {"min_depth", "max_depth"});
  expectRefused([](MapperConfig* c) { c->min_ray_length = 9.0; },
                {"min_ray_length", "9", "max_ray_length"});
  expectAccepted([](MapperConfig* c) { c->min_depth = 7.9, c->min_ray_length = 7.9; });
}

TEST(MapperConfigTest, OccupiedMustBeReachableAndLeavable) {
  expectRefused([](MapperConfig* c) { c->p_occ = 0.98; }, {"p_occ", "0.98", "p_max"});
  expectRefused([](MapperConfig* c) { c->p_occ = c->p_max; }, {"p_occ", "p_max"});
  expectRefused([](MapperConfig* c) { c->p_min = 0.40; }, {"p_min", "0.4", "p_miss"});
}

TEST(MapperConfigTest, VirtualFloorMustBeBelowTheCeilingWhenThereAreWalls) {
  const auto cross = [](MapperConfig* c) { c->virtual_floor = 3.5; };
  expectAccepted(cross);
  expectRefused([&](MapperConfig* c) { cross(c), c->virtual_walls = true; },
                {"virtual_floor", "3.5", "virtual_ceiling"});
  expectAccepted([](MapperConfig* c) { c->virtual_walls = true; });
}

TEST(MapperConfigTest, TheBodyHasAnExtentOnAllAxesOrNone) {
  const auto withBody = [](MapperConfig* c) {
    c->body_size_x = c->body_size_y = 0.6;
    c->body_size_z = 0.2;
  };
  expectAccepted(withBody);
  expectAccepted([&](MapperConfig* c) { withBody(c), c->clear_body = true; });
  expectRefused([&](MapperConfig* c) { withBody(c), c->body_size_y = 0.0; },
                {"body_size_x/y/z", "all must be above 0"});
  expectRefused([](MapperConfig* c) { c->clear_body = true; },
                {"body_size_x/y/z", "clear_body false"});
}

TEST(MapperConfigTest, ConnectivityIsOneOfThree) {
  for (const int good : {6, 18, 26}) {
    expectAccepted([&](MapperConfig* c) { c->bfs_connectivity = good; });
  }
  for (const int bad : {-6, 0, 4, 7, 8, 12, 19, 25, 27}) {
    expectRefused([&](MapperConfig* c) { c->bfs_connectivity = bad; },
                  {"bfs_connectivity", std::to_string(bad), "6, 18 or 26"});
  }
}

TEST(MapperConfigTest, TheWindowFollowsBeforeTheVehicleLeavesIt) {
  expectAccepted([](MapperConfig* c) { c->slide_distance = 3.0; });
  const auto slideFar = [](MapperConfig* c) { c->slide_distance = 3.1; };
  expectRefused(slideFar, {"slide_distance", "3.1", "[0, 3.0", "map_size"});
  expectRefused([](MapperConfig* c) { c->map_size_y = 0.5; }, {"slide_distance", "0.4", "0.25"});
  expectAccepted([&](MapperConfig* c) { slideFar(c), c->map_mode = MapMode::kFixed; });
}

TEST(MapperConfigTest, RadiusIsAtMost64Voxels) {
  expectAccepted([](MapperConfig* c) { c->inflation_radius = 6.4; });
  expectAccepted([](MapperConfig* c) { c->resolution = 0.05, c->inflation_radius = 3.2; });
  expectRefused([](MapperConfig* c) { c->inflation_radius = 6.6; },
                {"inflation_radius", "6.6", "64"});
}

TEST(MapperConfigTest, WindowIsAtMostTenThousandMillionVoxels) {
  expectAccepted([](MapperConfig* c) {
    c->map_size_x = c->map_size_y = 1000.0, c->memory_limit = 20000.0;  // MB
  });
  expectRefused([](MapperConfig* c) { c->map_size_x = c->map_size_y = 10000.0; },
                {"map_size", "resolution"});
}

TEST(MapperConfigTest, AMapThatNeedsMoreThanTheMemoryLimitIsRefusedWithBothAmounts) {
  // 32 x 32 tiles at most, 1024 columns each, 64 bits in three planes and 64 bytes: 92 MB.
  expectAccepted([](MapperConfig* c) { c->memory_limit = 100.0; });
  expectRefused([](MapperConfig* c) { c->memory_limit = 90.0; },
                {"map_size", "resolution", "needs 9", "90 MB are available", "memory_limit"});
}

TEST(MapperConfigTest, TheUpdateRangeCountsAsFarAsItLiesInTheWindow) {
  const auto update = [](double range) {
    return [range](MapperConfig* c) {
      c->map_size_x = c->map_size_y = 500.0;  // 2.3 GB
      c->local_update_range_x = c->local_update_range_y = range;
      c->memory_limit = 2500.0;
    };
  };
  expectAccepted(update(10.0));
  expectRefused(update(500.0), {"local_update_range", "2500 MB are available"});
  expectAccepted([](MapperConfig* c) {
    c->local_update_range_x = c->local_update_range_y = 10000.0, c->memory_limit = 150.0;
  });
}

TEST(MapperConfigTest, WithoutAMemoryLimitTheMachinesMemoryIsOne) {
  // Columns of one voxel take 64: 1000 GB, beyond what machines have.
  const auto enlarge = [](MapperConfig* c, double size) {
    c->resolution = 0.01, c->inflation_radius = 0.2;
    c->map_size_x = c->map_size_y = size, c->map_size_z = 0.01;
    c->slide_distance = 0.0;
    c->local_update_range_x = c->local_update_range_y = 10000.0;
    c->memory_limit = 1e6;
  };
  expectRefused([&](MapperConfig* c) { enlarge(c, 999.0), c->memory_limit = 0.0; },
                {"needs", "the machine's memory"});
  expectRefused([&](MapperConfig* c) { enlarge(c, 600.0); }, {"local_update_range", "2^31"});
}

}  // namespace
}  // namespace fiimap
