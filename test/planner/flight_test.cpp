#include "flight.h"

#include <cmath>
#include <limits>

#include "planner_map.h"

namespace fiimap {
namespace {

constexpr double kStep = 0.02;        // s, between steps of the flight
constexpr int kStepsPerScan = 5;      // a snapshot each
constexpr double kResolution = 0.1;   // m
constexpr double kSensorRange = 5.0;  // m
constexpr double kPatience = 120.0;   // s of simulated time
constexpr double kJerkiness = 1e-6;   // m

/// A vehicle that follows its commands exactly, in a world of which it sees what is near.
/// Everything that it flies is checked on the way.
class FlightTest : public ::testing::Test {
 protected:
  FlightTest()
      : truth_({260, 120, 30}, kResolution, 0.3),
        seen_({260, 120, 30}, kResolution, 0.3),
        flight_(quick(&config_), flight_config_, [this] { return time_ + planning_delay_; }) {
    vehicle_.position = {-11.0, 0.05, 0.05};
  }

  /// A search for a goal that cannot be reached ends early.
  static const PlannerConfig& quick(PlannerConfig* config) {
    config->max_visited = 20000;
    return *config;
  }

  void build(const VoxelBox& box) {
    test::forEachVoxel(box.intersection(truth_.window()), [this](const VoxelIndex& v) {
      truth_.occupy(v);
      unseen_.push_back(v);
    });
  }

  void look() {
    const auto is_near = [this](const VoxelIndex& v) {
      const Eigen::Vector3d center = (v.cast<double>().array() + 0.5) * kResolution;
      return (center - vehicle_.position).norm() <= kSensorRange;
    };
    std::vector<VoxelIndex> rest;
    for (const VoxelIndex& v : unseen_) {
      if (is_near(v)) {
        seen_.occupy(v);
      } else {
        rest.push_back(v);
      }
    }
    unseen_ = rest;
    snapshot_ = seen_.snapshot();
  }

  void step() {
    if (steps_++ % kStepsPerScan == 0 && map_works_) look();
    flight_.step(
        {time_, map_works_ ? snapshot_ : nullptr, vehicle_, map_trouble_, odometry_trouble_});
    time_ += kStep;
    if (!flight_.flown().current) return;
    const MotionState state = flight_.flown().at(time_).at(time_);
    const double moved = (state.position - vehicle_.position).norm();
    EXPECT_LE(moved, kStep * (config_.max_speed + 1e-3) + kJerkiness) << "the command jumped";
    const double max_change = kStep * (config_.max_acceleration + config_.max_braking + 0.1);
    EXPECT_LE((state.velocity - vehicle_.velocity).norm(), max_change) << "the speed jumped";
    vehicle_.position = state.position;
    vehicle_.velocity = state.velocity;
    const std::optional<double>& heading = flight_.flown().at(time_).heading();
    if (heading) vehicle_.yaw = *heading;
    way_.push_back(state.position);
  }

  template <typename Condition>
  bool flyUntil(Condition&& condition) {
    const double end = time_ + kPatience;
    while (time_ < end && !condition()) step();
    return condition();
  }
  bool flyUntil(FlightState state) {
    return flyUntil([&] { return flight_.status().state == state; });
  }
  void fly(double duration) {
    const double end = time_ + duration;
    flyUntil([&] { return time_ >= end; });
  }
  double speed() const { return vehicle_.velocity.norm(); }

  /// No place of the way is nearer to an obstacle than the inflation.
  void expectSafeWay() {
    const FlightSpace space = truth_.space();
    for (const Eigen::Vector3d& position : way_) {
      ASSERT_TRUE(space.isFree(position)) << position.transpose();
    }
  }

  PlannerConfig config_;
  FlightConfig flight_config_;
  double time_ = 100.0;
  double planning_delay_ = 0.0;
  bool map_works_ = true;
  std::string map_trouble_, odometry_trouble_;
  test::PlannerMap truth_, seen_;
  std::vector<VoxelIndex> unseen_;
  std::shared_ptr<const Snapshot> snapshot_;
  int steps_ = 0;
  VehicleState vehicle_;
  std::vector<Eigen::Vector3d> way_;
  Flight flight_;
};

TEST_F(FlightTest, ReachesAGoalThroughAForestThatItSeesOnTheWay) {
  for (unsigned seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    truth_.clear();
    seen_.clear();
    unseen_.clear();
    way_.clear();
    for (int i = 0; i < 45; ++i) {
      const int x = test::uniformInt(random, -90, 90), y = test::uniformInt(random, -60, 59);
      build({{x, y, -15}, {x + 3, y + 3, 15}});
    }
    vehicle_ = VehicleState();
    vehicle_.position = {-11.0, 0.05, 0.05};
    flight_.restart();
    flight_.setGoals({{11.0, 0.0, 0.0}});
    ASSERT_TRUE(flyUntil(FlightState::kGoalReached)) << flight_.status().reason;
    EXPECT_LT((vehicle_.position - Eigen::Vector3d(11, 0, 0)).norm(), 0.3);
    expectSafeWay();
    EXPECT_GT(flight_.status().plans, 3u);
  }
}

TEST_F(FlightTest, StopsBeforeAWallThatClosesTheWay) {
  build({{0, -60, -15}, {2, 60, 15}});
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil(FlightState::kNoPath));
  EXPECT_LT(speed(), 1e-6);
  EXPECT_LT(vehicle_.position.x(), -0.3);
  EXPECT_GT(vehicle_.position.x(), -2.0);
  expectSafeWay();
}

TEST_F(FlightTest, LooksAllAroundOnceWhenThereIsNoWay) {
  build({{0, -60, -15}, {2, 60, 15}});
  flight_.setGoals({{11.0, 0.0, 0.0}});
  std::vector<double> headings{vehicle_.yaw};  // that it looked to, one after the other
  const double end = time_ + 30.0;
  flyUntil([&] {
    if (vehicle_.yaw != headings.back()) headings.push_back(vehicle_.yaw);
    return time_ >= end;
  });
  EXPECT_EQ(flight_.status().state, FlightState::kNoPath);
  const double seen = 2.0 * flight_config_.view_azimuth;
  for (std::size_t i = 1; i < headings.size(); ++i) {
    EXPECT_LE(headings[i] - headings[i - 1], seen + 1e-9) << "something was left out";
  }
  EXPECT_GE(headings.back() - headings.front() + seen, 2.0 * M_PI) << "a part was not looked at";
  EXPECT_LT(headings.back() - headings.front(), 2.0 * M_PI) << "it looked there before";
}

TEST_F(FlightTest, FliesOnWhenItSeesAWayBehindItself) {
  build({{0, -60, -15}, {2, 60, 15}});
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil(FlightState::kNoPath));
  EXPECT_TRUE(flyUntil([&] { return std::cos(vehicle_.yaw) < -0.5; })) << "it never looked back";
  seen_.clear();
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached)) << flight_.status().reason;
}

TEST_F(FlightTest, BrakesForAnObstacleThatAppearsAllAround) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > 0.0; }));
  ASSERT_GT(speed(), 1.5);
  build({{25, -60, -15}, {27, 60, 15}});
  ASSERT_TRUE(flyUntil([&] { return speed() < 1e-6; }));
  EXPECT_LT(vehicle_.position.x(), 2.2);
  expectSafeWay();
}

TEST_F(FlightTest, FliesThroughWaypointsWithoutAStop) {
  flight_.setGoals({{-5.0, 4.0, 0.0}, {0.0, -3.0, 0.5}, {5.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return flight_.goals().size() == 2; }));
  EXPECT_GT(speed(), 0.3);
  ASSERT_TRUE(flyUntil([&] { return flight_.goals().size() == 1; }));
  ASSERT_TRUE(flyUntil(FlightState::kGoalReached));
  EXPECT_LT((vehicle_.position - Eigen::Vector3d(5, 0, 0)).norm(), 0.3);
}

TEST_F(FlightTest, BrakesWithoutAMapAndGoesOnWhenItIsBack) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  map_works_ = false;
  map_trouble_ = "gone";
  step();
  EXPECT_EQ(flight_.status().state, FlightState::kBraking);
  EXPECT_EQ(flight_.status().reason, "gone");
  const Eigen::Vector3d position = vehicle_.position;
  ASSERT_TRUE(flyUntil(FlightState::kWaiting));
  EXPECT_LT(speed(), 1e-6);
  EXPECT_LT((vehicle_.position - position).norm(), 1.0);
  EXPECT_TRUE(flight_.flown().current) << "it keeps its place";
  map_works_ = true;
  map_trouble_.clear();
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached));
}

TEST_F(FlightTest, BrakesWithoutOdometryAndThenCommandsNothing) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  odometry_trouble_ = "no odometry";
  step();
  EXPECT_EQ(flight_.status().state, FlightState::kBraking);
  ASSERT_TRUE(flyUntil(FlightState::kWaiting));
  EXPECT_LT(speed(), 1e-6);
  step();
  EXPECT_FALSE(flight_.flown().current);
  odometry_trouble_.clear();
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached));
}

TEST_F(FlightTest, FliesOnWhatWasCheckedWhileTheMapIsReset) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  map_works_ = false;
  seen_.clear();
  seen_.forget(seen_.window());
  const std::uint64_t plans = flight_.status().plans;
  fly(0.5);
  EXPECT_EQ(flight_.status().state, FlightState::kFlying);
  EXPECT_GT(speed(), 1.0);
  EXPECT_LE(flight_.status().plans, plans + 1);
  map_works_ = true;
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached));
}

TEST_F(FlightTest, GetsOutOfInflatedSpaceFirst) {
  build({{-106, -60, -15}, {-105, 60, 15}});  // 0.4 m in front of the vehicle
  vehicle_.position.x() = -10.75;
  ASSERT_FALSE(truth_.space().isFree(vehicle_.position));
  flight_.setGoals({{-12.5, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil(FlightState::kGoalReached)) << flight_.status().reason;
  const FlightSpace space = truth_.space();
  for (const Eigen::Vector3d& position : way_) {
    EXPECT_TRUE(space.isCrossable(space.lattice().indexOf(position)));
  }
}

TEST_F(FlightTest, APlanThatTookTooLongIsNotFlown) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  planning_delay_ = 60.0;
  const std::uint64_t plans = flight_.status().plans;
  fly(1.0);
  EXPECT_EQ(flight_.status().plans, plans);
  EXPECT_GT(flight_.status().failures, 0u);
}

TEST_F(FlightTest, StartsAnewWhereTheVehicleIsWhenItIsNotWhereItShouldBe) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  vehicle_.position.y() += 3.0;
  step();
  EXPECT_NEAR(vehicle_.position.y(), 3.05, 0.1);
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached));
}

TEST_F(FlightTest, TurnsBeforeItFliesBackwards) {
  vehicle_.yaw = 3.0;
  flight_.setGoals({{11.0, 0.0, 0.0}});
  step();
  EXPECT_EQ(flight_.status().state, FlightState::kHovering);
  ASSERT_TRUE(flight_.flown().current->heading());
  EXPECT_NEAR(*flight_.flown().current->heading(), 0.0, 0.3);
  EXPECT_TRUE(flyUntil(FlightState::kFlying));
}

TEST_F(FlightTest, BrakesAndTurnsBeforeItGetsToWhereItDidNotLook) {
  seen_.forget({{-130, 8, -15}, {130, 60, 15}});
  flight_.setGoals({{-5.0, 0.0, 0.0}, {-5.0, 5.0, 0.0}});
  bool braked = false, turned = false;
  flyUntil([&] {
    const FlightStatus& status = flight_.status();
    braked = braked || status.state == FlightState::kBraking;
    turned = turned || (braked && status.state == FlightState::kHovering);
    const bool unseen = vehicle_.position.y() > 0.8;
    EXPECT_TRUE(!unseen || std::abs(vehicle_.yaw) > 0.5) << "flew where it did not look";
    return status.state == FlightState::kGoalReached || ::testing::Test::HasFailure();
  });
  EXPECT_TRUE(braked);
  EXPECT_TRUE(turned);
  EXPECT_EQ(flight_.status().state, FlightState::kGoalReached) << flight_.status().reason;
}

TEST_F(FlightTest, GetsAwayFromWhereTheMapHasAnObstacleNow) {
  flight_.setGoals({{11.0, 0.0, 0.0}});
  step();
  ASSERT_TRUE(flyUntil([&] { return vehicle_.position.x() > -5.0; }));
  map_works_ = false;
  map_trouble_ = "gone";
  ASSERT_TRUE(flyUntil(FlightState::kWaiting));
  map_works_ = true;
  map_trouble_.clear();
  const VoxelIndex here = truth_.space().lattice().indexOf(vehicle_.position);
  build({here, here + VoxelIndex::Ones()});
  EXPECT_TRUE(flyUntil(FlightState::kGoalReached)) << flight_.status().reason;
}

TEST_F(FlightTest, ABlockedGoalIsApproached) {
  build({{50, -10, -15}, {70, 10, 15}});
  flight_.setGoals({{6.0, 0.0, 0.0}});
  ASSERT_TRUE(flyUntil(FlightState::kNoPath));
  EXPECT_LT((vehicle_.position - Eigen::Vector3d(6, 0, 0)).norm(), 2.0);
  expectSafeWay();
}

}  // namespace
}  // namespace fiimap
