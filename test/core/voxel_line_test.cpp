#include "fiimap/voxel_line.h"

#include <map>

#include "effort.h"
#include "line_oracle.h"
#include "oracle.h"

namespace fiimap {
namespace {

using test::GridSegment;
using Vector = Eigen::Vector3d;

struct Visit {
  VoxelIndex v;
  double t_in, t_out;
};

std::vector<Visit> visitsOf(const Vector& from, const Vector& to) {
  std::vector<Visit> visits;
  EXPECT_TRUE(forEachVoxelOnLine(from, to, [&](const VoxelIndex& v, double t_in, double t_out) {
    visits.push_back({v, t_in, t_out});
    return true;
  }));
  return visits;
}

test::VoxelSet voxelsOnLine(const Vector& from, const Vector& to) {
  test::VoxelSet voxels;
  for (const Visit& visit : visitsOf(from, to)) voxels.insert(visit.v);
  return voxels;
}

/// Compares a walk with the definition: the same voxels, each once, with their shares, in order.
void expectDefinition(const GridSegment& segment) {
  constexpr double kRounding = 1e-12;
  const std::vector<test::PassedVoxel> expected = segment.passed();
  std::map<VoxelIndex, test::PassedVoxel, test::VoxelLess> missing;
  for (const test::PassedVoxel& passed : expected) missing.emplace(passed.v, passed);
  double before = 0.0;
  for (const Visit& visit : visitsOf(segment.from(), segment.to())) {
    const auto found = missing.find(visit.v);
    ASSERT_NE(found, missing.end()) << test::describe(visit.v) << " is not passed, or seen twice";
    ASSERT_NEAR(visit.t_in, found->second.t_in.value(), kRounding) << test::describe(visit.v);
    ASSERT_NEAR(visit.t_out, found->second.t_out.value(), kRounding) << test::describe(visit.v);
    ASSERT_GE(visit.t_in, before) << "out of order";
    before = visit.t_in;
    missing.erase(found);
  }
  ASSERT_TRUE(missing.empty()) << test::describe(missing.begin()->first) << " is left out";
}

VoxelIndex randomParts(test::Random& random, const VoxelIndex& around, const VoxelIndex& reach) {
  const VoxelIndex parts = reach * GridSegment::kParts;
  return around * GridSegment::kParts +
         test::uniformVoxel(random, {-parts, parts + VoxelIndex::Ones()});
}

TEST(VoxelLineTest, VisitsTheVoxelsOfTheDefinition) {
  test::Random random(511);
  const VoxelIndex zero = VoxelIndex::Zero();
  for (int round = 0; round < test::effort(5000); ++round) {
    SCOPED_TRACE("seed 511, round " + std::to_string(round));
    const VoxelIndex reach = VoxelIndex::Constant(test::uniformInt(random, 1, 5));
    const VoxelIndex from = randomParts(random, zero, reach);
    VoxelIndex to = randomParts(random, zero, reach);
    if (test::chance(random, 0.3)) {  // along an axis or within a plane, often within a face
      to[test::uniformInt(random, 0, 2)] = from[test::uniformInt(random, 0, 2)];
      const int axis = test::uniformInt(random, 0, 2);
      to[axis] = from[axis];
    }
    ASSERT_NO_FATAL_FAILURE(expectDefinition({from, to}));
  }
}

TEST(VoxelLineTest, LongLinesFarFromTheOriginAreExactToo) {
  test::Random random(512);
  const VoxelIndex around(1000000, -3000000, 2000000);
  for (int round = 0; round < test::effort(200); ++round) {
    SCOPED_TRACE("seed 512, round " + std::to_string(round));
    VoxelIndex reach = VoxelIndex::Constant(2);
    reach[round % 3] = 1500;
    ASSERT_NO_FATAL_FAILURE(
        expectDefinition({randomParts(random, around, reach), randomParts(random, around, reach)}));
  }
}

/// Whether the line has a point in a closed box (by clipping it axis by axis).
bool touches(const Vector& from, const Vector& to, const Vector& low, const Vector& high) {
  double begin = 0.0, end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double direction = to[axis] - from[axis];
    if (direction == 0.0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
      continue;
    }
    const double a = (low[axis] - from[axis]) / direction;
    const double b = (high[axis] - from[axis]) / direction;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

Vector randomPoint(test::Random& random, double reach) {
  return Vector::NullaryExpr(
      [&](Eigen::Index) { return test::uniformReal(random, -reach, reach); });
}

TEST(VoxelLineTest, OfAnyLineVisitsAllThatItTouchesAndNothingElse) {
  test::Random random(513);
  constexpr double kReach = 4.0, kMargin = 1e-6;
  for (int round = 0; round < test::effort(2000); ++round) {
    const Vector from = randomPoint(random, kReach), to = randomPoint(random, kReach);
    const test::VoxelSet visited = voxelsOnLine(from, to);
    test::forEachVoxel({VoxelIndex::Constant(-5), VoxelIndex::Constant(5)},
                       [&](const VoxelIndex& v) {
                         const Vector low = v.cast<double>(), high = low.array() + 1.0;
                         const Vector margin = Vector::Constant(kMargin);
                         if (touches(from, to, low + margin, high - margin)) {
                           EXPECT_EQ(visited.count(v), 1u)
                               << "seed 513, round " << round << " " << test::describe(v);
                         } else if (!touches(from, to, low - margin, high + margin)) {
                           EXPECT_EQ(visited.count(v), 0u)
                               << "seed 513, round " << round << " " << test::describe(v);
                         }
                       });
  }
}

TEST(VoxelLineTest, HoldsTheVoxelOfEveryPointOfALongLine) {
  test::Random random(514);
  for (int round = 0; round < test::effort(30); ++round) {
    const Vector from = randomPoint(random, 2e4), to = randomPoint(random, 2e4);
    const test::VoxelSet visited = voxelsOnLine(from, to);
    EXPECT_EQ(visited.count(from.array().floor().cast<int>()), 1u);
    EXPECT_EQ(visited.count(to.array().floor().cast<int>()), 1u);
    for (int i = 0; i < 2000; ++i) {
      const long double t = test::uniformReal(random, 0.0, 1.0);
      const VoxelIndex v =
          (from.cast<long double>() + t * (to.cast<long double>() - from.cast<long double>()))
              .array()
              .floor()
              .cast<int>();
      ASSERT_EQ(visited.count(v), 1u) << "seed 514, round " << round << " " << test::describe(v);
    }
  }
}

TEST(VoxelLineTest, VisitsAllAroundACornerThatItPasses) {
  const Vector half = Vector::Constant(0.5);
  EXPECT_EQ(voxelsOnLine(half, half + Vector(1, 1, 0)).size(), 4u);
  EXPECT_EQ(voxelsOnLine(half, half + Vector(1, 1, 1)).size(), 8u);
  EXPECT_EQ(voxelsOnLine(half, half - Vector(2, 0, 2)).size(), 7u);
}

TEST(VoxelLineTest, AnEdgeThatRoundingMissesIsPassedAllTheSame) {
  // 0.1, 0.3 and 0.7 are no binary fractions: the line crosses the edge at (1, 1) but for rounding.
  EXPECT_EQ(voxelsOnLine({0.1, 0.7, 0.5}, {1.9, 1.3, 0.5}).size(), 4u);
  EXPECT_EQ(voxelsOnLine({1.9, 1.3, 0.5}, {0.1, 0.7, 0.5}).size(), 4u);
}

TEST(VoxelLineTest, ALineWithinAFaceHasTheVoxelsAboveIt) {
  EXPECT_EQ(voxelsOnLine({0.5, 2.0, 0.5}, {1.5, 2.0, 0.5}), (test::VoxelSet{{0, 2, 0}, {1, 2, 0}}));
}

TEST(VoxelLineTest, ALineThatEndsAtABorderHasTheVoxelOfItsEnd) {
  EXPECT_EQ(voxelsOnLine({0.5, 0.5, 0.5}, {2.0, 0.5, 0.5}),
            (test::VoxelSet{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(voxelsOnLine({2.0, 0.5, 0.5}, {0.5, 0.5, 0.5}),
            (test::VoxelSet{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
}

TEST(VoxelLineTest, TellsWhereItEntersAndLeaves) {
  const std::vector<Visit> visits = visitsOf({0.5, 0.25, -0.5}, {2.5, 1.0, -0.5});
  ASSERT_EQ(visits.size(), 4u);
  EXPECT_EQ(visits[0].v, VoxelIndex(0, 0, -1));
  EXPECT_EQ(visits[0].t_in, 0.0);
  EXPECT_EQ(visits[0].t_out, 0.25);
  EXPECT_EQ(visits[1].v, VoxelIndex(1, 0, -1));
  EXPECT_EQ(visits[1].t_out, 0.75);
  EXPECT_EQ(visits[2].v, VoxelIndex(2, 0, -1));
  EXPECT_EQ(visits[2].t_out, 1.0);
  EXPECT_EQ(visits[3].v, VoxelIndex(2, 1, -1));
  EXPECT_EQ(visits[3].t_in, 1.0);
  EXPECT_EQ(visits[3].t_out, 1.0);
}

TEST(VoxelLineTest, APointIsOneVoxel) {
  EXPECT_EQ(voxelsOnLine({0.2, -0.2, 3.0}, {0.2, -0.2, 3.0}), (test::VoxelSet{{0, -1, 3}}));
  EXPECT_EQ(visitsOf({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}).front().t_out, 1.0);
}

TEST(VoxelLineTest, ALineShorterThanAnyNumberCrossesTheBordersThatLieInIt) {
  constexpr double kTiny = 1e-310;
  EXPECT_EQ(voxelsOnLine({-kTiny, 0.5, 0.5}, {kTiny, 0.5, 0.5}),
            (test::VoxelSet{{-1, 0, 0}, {0, 0, 0}}));
}

TEST(VoxelLineTest, StopsWhenTold) {
  int visits = 0;
  const auto stop = [&](const VoxelIndex&, double, double) { return ++visits < 3; };
  EXPECT_FALSE(forEachVoxelOnLine({0.5, 0.5, 0.5}, {9.5, 0.5, 0.5}, stop));
  EXPECT_EQ(visits, 3);
  visits = 1;  // at the second voxel: beside the line, around a corner
  EXPECT_FALSE(forEachVoxelOnLine({0.5, 0.5, 0.5}, {9.5, 9.5, 9.5}, stop));
  EXPECT_EQ(visits, 3);
}

}  // namespace
}  // namespace fiimap
