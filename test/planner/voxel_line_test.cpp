#include "voxel_line.h"

#include "../core/oracle.h"

namespace fiimap {
namespace {

using Vector = Eigen::Vector3d;

test::VoxelSet voxelsOnLine(const Vector& from, const Vector& to) {
  test::VoxelSet voxels;
  forEachVoxelOnLine(from, to, [&](const VoxelIndex& v) {
    voxels.insert(v);
    return true;
  });
  return voxels;
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

TEST(VoxelLineTest, VisitsAllThatTheLineTouchesAndNothingElse) {
  test::Random random(511);
  constexpr double kReach = 4.0, kMargin = 1e-6;
  for (int round = 0; round < 2000; ++round) {
    const auto corner = [&] {
      return Vector::NullaryExpr(
                 [&](Eigen::Index) { return test::uniformReal(random, -kReach, kReach); })
          .eval();
    };
    const Vector from = corner(), to = corner();
    const test::VoxelSet visited = voxelsOnLine(from, to);
    test::forEachVoxel({VoxelIndex::Constant(-5), VoxelIndex::Constant(5)},
                       [&](const VoxelIndex& v) {
                         const Vector low = v.cast<double>(), high = low.array() + 1.0;
                         const Vector margin = Vector::Constant(kMargin);
                         if (touches(from, to, low + margin, high - margin)) {
                           EXPECT_EQ(visited.count(v), 1u)
                               << "seed 511, round " << round << " " << test::describe(v);
                         } else if (!touches(from, to, low - margin, high + margin)) {
                           EXPECT_EQ(visited.count(v), 0u)
                               << "seed 511, round " << round << " " << test::describe(v);
                         }
                       });
  }
}

TEST(VoxelLineTest, VisitsAllAroundACornerThatItPasses) {
  const Vector half = Vector::Constant(0.5);
  EXPECT_EQ(voxelsOnLine(half, half + Vector(1, 1, 0)).size(), 4u);
  EXPECT_EQ(voxelsOnLine(half, half + Vector(1, 1, 1)).size(), 8u);
  EXPECT_EQ(voxelsOnLine(half, half - Vector(2, 0, 2)).size(), 7u);
}

TEST(VoxelLineTest, APointIsOneVoxel) {
  EXPECT_EQ(voxelsOnLine({0.2, -0.2, 3.0}, {0.2, -0.2, 3.0}), (test::VoxelSet{{0, -1, 3}}));
}

TEST(VoxelLineTest, StopsWhenTold) {
  int visits = 0;
  EXPECT_FALSE(forEachVoxelOnLine({0.5, 0.5, 0.5}, {9.5, 0.5, 0.5},
                                  [&](const VoxelIndex&) { return ++visits < 3; }));
  EXPECT_EQ(visits, 3);
}

}  // namespace
}  // namespace fiimap
