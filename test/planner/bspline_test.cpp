#include "bspline.h"

#include "../core/oracle.h"

namespace fiimap {
namespace {

Eigen::Vector3d randomVector(test::Random& random, double reach) {
  return Eigen::Vector3d::NullaryExpr(
      [&](Eigen::Index) { return test::uniformReal(random, -reach, reach); });
}

Bspline randomCurve(test::Random& random) {
  Bspline::Points control;
  const int count = test::uniformInt(random, 4, 12);
  for (int i = 0; i < count; ++i) control.push_back(randomVector(random, 2.0));
  return {control, test::uniformReal(random, 0.1, 0.5)};
}

/// The definition by recursion over the degree (de Boor, Cox): basis function i of a degree over
/// the knots 0, 1, 2, ...
double basis(int i, int degree, double u) {
  if (degree == 0) return u >= i && u < i + 1 ? 1.0 : 0.0;
  return (u - i) / degree * basis(i, degree - 1, u) +
         (i + degree + 1 - u) / degree * basis(i + 1, degree - 1, u);
}

TEST(BsplineTest, IsTheSumOfItsBasisFunctions) {
  test::Random random(531);
  for (int round = 0; round < 100; ++round) {
    const Bspline curve = randomCurve(random);
    const double time = test::uniformReal(random, 0.0, 0.999) * curve.duration();
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < curve.control().size(); ++i) {
      expected += curve.control()[i] * basis(static_cast<int>(i), Bspline::kDegree,
                                             time / curve.interval() + Bspline::kDegree);
    }
    EXPECT_LT((curve.at(time).position - expected).norm(), 1e-9) << "seed 531";
  }
}

TEST(BsplineTest, VelocityAndAccelerationAreTheDerivatives) {
  test::Random random(532);
  constexpr double kStep = 1e-4;
  for (int round = 0; round < 100; ++round) {
    const Bspline curve = randomCurve(random);
    const double time = test::uniformReal(random, 0.01, 0.99) * curve.duration();
    const MotionState before = curve.at(time - kStep), at = curve.at(time),
                      after = curve.at(time + kStep);
    EXPECT_LT(((after.position - before.position) / (2 * kStep) - at.velocity).norm(), 0.01);
    EXPECT_LT(((after.velocity - before.velocity) / (2 * kStep) - at.acceleration).norm(),
              0.01 * (1.0 + at.acceleration.norm()) + 1.0);
  }
}

TEST(BsplineTest, BeginsInTheGivenState) {
  test::Random random(533);
  for (int round = 0; round < 100; ++round) {
    const MotionState state{randomVector(random, 10), randomVector(random, 3),
                            randomVector(random, 5)};
    constexpr double kInterval = 0.2;
    Bspline::Points control = Bspline::controlOf(state, kInterval);
    control.push_back(randomVector(random, 10));
    const MotionState start = Bspline(control, kInterval).at(0.0);
    EXPECT_LT((start.position - state.position).norm(), 1e-9);
    EXPECT_LT((start.velocity - state.velocity).norm(), 1e-9);
    EXPECT_LT((start.acceleration - state.acceleration).norm(), 1e-9);
  }
}

TEST(BsplineTest, BoundsHoldAndAreNotFarOff) {
  test::Random random(534);
  for (int round = 0; round < 200; ++round) {
    const Bspline curve = randomCurve(random);
    double speed = 0.0, acceleration = 0.0;
    constexpr int kSamples = 1000;
    for (int i = 0; i <= kSamples; ++i) {
      const MotionState state = curve.at(curve.duration() * i / kSamples);
      speed = std::max(speed, state.velocity.norm());
      acceleration = std::max(acceleration, state.acceleration.norm());
    }
    EXPECT_LE(speed, curve.speedBound() + 1e-9);
    EXPECT_GE(speed, 0.5 * curve.speedBound());
    EXPECT_LE(acceleration, curve.accelerationBound() + 1e-9);
    EXPECT_GE(acceleration, 0.9 * curve.accelerationBound());
  }
}

}  // namespace
}  // namespace fiimap
