#include "guide_path.h"

#include "planner_map.h"

namespace fiimap {
namespace {

TEST(PolylineTest, IsWalkedByLength) {
  const Polyline line({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 1, 0}});
  EXPECT_EQ(line.length(), 3.0);
  EXPECT_TRUE(line.at(-1.0).isApprox(Eigen::Vector3d::Zero()));
  EXPECT_TRUE(line.at(1.5).isApprox(Eigen::Vector3d(1.5, 0, 0)));
  EXPECT_TRUE(line.at(2.5).isApprox(Eigen::Vector3d(2, 0.5, 0)));
  EXPECT_TRUE(line.at(9.0).isApprox(Eigen::Vector3d(2, 1, 0)));
  EXPECT_TRUE(Polyline({{1, 2, 3}}).at(1.0).isApprox(Eigen::Vector3d(1, 2, 3)));
}

TEST(ShortcutTest, IsFreeAndNoLongerAndKeepsItsEnds) {
  test::Random random(521);
  PathSearch search(100000);
  int shorter = 0;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE("seed 521, round " + std::to_string(round));
    test::PlannerMap map({40, 40, 10}, 0.1, 0.1);
    test::scatter(random, 12, 6, &map);
    const FlightSpace space = map.space();
    const VoxelIndex from(-19, -19, 0), to(19, 19, 0);
    const VoxelPath path = search.find(space, from, to, map.window(), 10.0);
    if (path.end != PathEnd::kGoal || path.escape > 0) continue;
    const Polyline line = throughCenters(path, space.lattice().centerOf(from),
                                         space.lattice().centerOf(to), space.lattice());
    const Polyline short_line = shortcut(line, space, 1);
    EXPECT_EQ(short_line.points().front(), line.points().front());
    EXPECT_EQ(short_line.points().back(), line.points().back());
    EXPECT_LE(short_line.length(), line.length() + 1e-9);
    shorter += short_line.length() < line.length() - 0.01 ? 1 : 0;
    for (std::size_t i = 1; i < short_line.points().size(); ++i) {
      EXPECT_TRUE(space.isLineFree(short_line.points()[i - 1], short_line.points()[i]));
    }
  }
  EXPECT_GT(shorter, 10);
}

class SpeedProfileTest : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(SpeedProfileTest, CoversItsLengthWithinItsLimits) {
  const auto [length, initial_speed] = GetParam();
  constexpr double kCruise = 2.0, kAcceleration = 1.0, kStep = 1e-3;
  const SpeedProfile profile(length, initial_speed, kCruise, kAcceleration);
  EXPECT_NEAR(profile.at(0.0), 0.0, 1e-9);
  EXPECT_NEAR(profile.at(profile.duration()), length, 1e-6);
  if (length > 0.0) {
    EXPECT_NEAR(profile.at(kStep) / kStep, initial_speed, 0.01);
  }
  const bool can_stop = initial_speed * initial_speed <= 2.0 * kAcceleration * length;
  double previous = initial_speed;
  for (double time = 0.0; time + kStep < profile.duration(); time += kStep) {
    const double speed = (profile.at(time + kStep) - profile.at(time)) / kStep;
    EXPECT_GE(speed, -1e-9);
    EXPECT_LE(speed, std::max(kCruise, initial_speed) + 1e-6);
    if (can_stop) {
      EXPECT_LE(std::abs(speed - previous) / kStep, 1.02 * kAcceleration + 1.0);
    }
    previous = speed;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, SpeedProfileTest,
                         ::testing::Values(std::make_pair(10.0, 0.0), std::make_pair(1.0, 0.0),
                                           std::make_pair(10.0, 1.5), std::make_pair(10.0, 3.0),
                                           std::make_pair(0.5, 2.0), std::make_pair(2.0, 2.0),
                                           std::make_pair(0.0, 0.0), std::make_pair(4.0, 2.5)));

}  // namespace
}  // namespace fiimap
