#include "closed_loop.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "baselines/thread_clock.h"

namespace fiimap {
namespace {

constexpr double kLength = 15.0;  // m

/// A short flight between trees.
FlightSettings shortFlight() {
  FlightSettings settings;
  settings.time_limit = 60.0;
  for (const char* setting :
       {"simulator.length=15", "simulator.tree_density=0.12", "simulator.image_width=160",
        "simulator.image_height=120", "simulator.max_range=10", "simulator.depth_noise=true",
        "map.pixel_step=1", "map.map_size_x=40", "map.map_size_y=40", "map.inflation_radius=0.4",
        "map.virtual_walls=true", "map.virtual_floor=0.3", "map.virtual_ceiling=3.5",
        "planner.goal_tolerance=0.5"}) {
    applySetting(setting, &settings);
  }
  return settings;
}

TEST(ClosedLoopTest, ReachesTheGoalWithoutCollision) {
  const FlightOutcome outcome = flyClosedLoop(shortFlight());
  EXPECT_TRUE(outcome.reached);
  EXPECT_EQ(outcome.truth.collisions, 0u);
  EXPECT_GT(outcome.truth.path_length, kLength - 1.0);
  EXPECT_GT(outcome.update_ms.size(), 100u);
  EXPECT_EQ(outcome.planning_ms.size(), outcome.planner.plans + outcome.planner.failures);
}

TEST(ClosedLoopTest, PartsShareTheCpuTimeOfTheFlight) {
  FlightSettings settings = shortFlight();
  settings.time_limit = 3.0;
  CpuTimes cpu_s;
  constexpr double kMicroseconds = 1e-6;  // s
  const double whole =
      kMicroseconds * bench::microsecondsOf([&] { cpu_s = flyClosedLoop(settings).cpu_s; });
  for (const double part : {cpu_s.simulation, cpu_s.mapping, cpu_s.planning}) {
    EXPECT_GT(part, 0.0);
  }
  EXPECT_LT(cpu_s.simulation + cpu_s.mapping + cpu_s.planning, whole);
}

TEST(ClosedLoopTest, FindsItsWayOutOfDeadEnds) {
  FlightSettings settings = shortFlight();
  settings.time_limit = 120.0;
  applySetting("simulator.world=maze", &settings);
  applySetting("simulator.maze_cells=4", &settings);
  for (const char* seed : {"1", "4"}) {
    SCOPED_TRACE(std::string("seed ") + seed);
    applySetting(std::string("simulator.seed=") + seed, &settings);
    const FlightOutcome outcome = flyClosedLoop(settings);
    EXPECT_TRUE(outcome.reached);
    EXPECT_EQ(outcome.truth.collisions, 0u);
    EXPECT_GT(outcome.truth.least_clearance, 0.3);
  }
}

TEST(ClosedLoopTest, TheSameSettingsGiveTheSameFlight) {
  const FlightOutcome first = flyClosedLoop(shortFlight());
  const FlightOutcome second = flyClosedLoop(shortFlight());
  EXPECT_EQ(first.seconds, second.seconds);
  EXPECT_EQ(first.truth.path_length, second.truth.path_length);
  EXPECT_EQ(first.truth.least_clearance, second.truth.least_clearance);
}

TEST(ClosedLoopTest, CollidesOnAMapThatSeesNothing) {
  FlightSettings settings = shortFlight();
  applySetting("map.max_depth=0.31", &settings);
  applySetting("map.max_ray_length=0.31", &settings);
  std::uint64_t collisions = 0;
  for (const char* seed : {"1", "2", "3"}) {
    applySetting(std::string("simulator.seed=") + seed, &settings);
    collisions += flyClosedLoop(settings).truth.collisions;
  }
  EXPECT_GT(collisions, 0u);
}

TEST(ClosedLoopTest, BadSettingsAreNamed) {
  FlightSettings settings;
  EXPECT_THROW(applySetting("map.resolution=-1", &settings), std::invalid_argument);
  EXPECT_THROW(applySetting("map.no_such=1", &settings), std::invalid_argument);
  EXPECT_THROW(applySetting("vehicle.max_speed=1", &settings), std::invalid_argument);
  EXPECT_THROW(applySetting("max_speed", &settings), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap
