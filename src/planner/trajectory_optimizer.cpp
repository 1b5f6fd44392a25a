#include "trajectory_optimizer.h"

#include <algorithm>
#include <cmath>

#include <nlopt.h>

#include "trajectory.h"

namespace fiimap {
namespace {

constexpr int kRounds = 12;        // of minimising and pushing out
constexpr int kEvaluations = 150;  // of the cost in one round
constexpr double kTolerance = 1e-4;
constexpr unsigned kRemembered = 10;     // steps of L-BFGS that estimate the curvature
constexpr int kEnds = Bspline::kDegree;  // control points that stay at each end
// Weights of the parts of the cost, found by trying.
constexpr double kSmoothness = 1.0, kClearance = 100.0, kLimits = 1.0;
constexpr double kPart = 0.9;   // of a limit from which on it costs
constexpr double kTiny = 1e-6;  // m

/// Adds to the cost what a difference of control points exceeds a limit by.
/// \return derivative of the cost with respect to the difference.
Eigen::Vector3d addExcess(const Eigen::Vector3d& difference, double limit, double* cost) {
  const double squared = (kPart * limit) * (kPart * limit);
  const double excess = difference.squaredNorm() / squared - 1.0;
  if (excess <= 0.0) return Eigen::Vector3d::Zero();
  *cost += kLimits * excess * excess;
  return 4.0 * kLimits * excess / squared * difference;
}

}  // namespace

TrajectoryOptimizer::TrajectoryOptimizer(const FlightSpace& space, const Settings& settings)
    : space_(space), settings_(settings) {}

std::optional<Bspline> TrajectoryOptimizer::optimize(const Bspline& guide) {
  half_spaces_.clear();
  Bspline curve = guide;
  for (int round = 0; round < kRounds; ++round) {
    curve = minimize(curve);
    if (isFreeOrPushed(curve, guide)) return curve;
  }
  return std::nullopt;
}

Bspline TrajectoryOptimizer::minimize(const Bspline& start) const {
  const int variables = static_cast<int>(start.control().size()) - 2 * kEnds;
  if (variables <= 0) return start;

  struct Problem {
    const TrajectoryOptimizer* optimizer;
    double interval;
    Bspline::Points control, gradient;
  } problem{this, start.interval(), start.control(), start.control()};
  const auto evaluate = [](unsigned size, const double* x, double* gradient, void* data) {
    auto* const p = static_cast<Problem*>(data);
    std::copy(x, x + size, p->control[kEnds].data());
    const double cost = p->optimizer->cost(p->control, p->interval, &p->gradient);
    if (gradient != nullptr) {
      std::copy_n(p->gradient[kEnds].data(), size, gradient);
    }
    return cost;
  };

  const unsigned size = 3 * static_cast<unsigned>(variables);
  std::vector<double> x(problem.control[kEnds].data(), problem.control[kEnds].data() + size);
  nlopt_opt optimizer = nlopt_create(NLOPT_LD_LBFGS, size);
  nlopt_set_min_objective(optimizer, evaluate, &problem);
  nlopt_set_maxeval(optimizer, kEvaluations);
  nlopt_set_ftol_rel(optimizer, kTolerance);
  nlopt_set_vector_storage(optimizer, kRemembered);
  double cost = 0.0;
  // Whatever ended it, x is the best point so far; whether that is good enough is checked later.
  nlopt_optimize(optimizer, x.data(), &cost);
  nlopt_destroy(optimizer);
  Bspline::Points control = start.control();
  std::copy(x.begin(), x.end(), control[kEnds].data());
  return {std::move(control), start.interval()};
}

bool TrajectoryOptimizer::isFreeOrPushed(const Bspline& curve, const Bspline& guide) {
  const Trajectory trajectory(curve, 0.0);
  const std::optional<double> first =
      firstCollision(trajectory, space_, {0.0}, settings_.max_escape);
  if (!first) return true;
  // Everything that is not free is pushed at once, from the first collision on.
  const double step = space_.resolution() / 2.0 / std::max(kTiny, curve.speedBound());
  for (double time = *first; time < curve.duration() + step; time += step) {
    const Eigen::Vector3d point = curve.at(time).position;
    if (space_.isFree(point)) continue;
    // The control point with the most influence there, and its neighbours.
    const int middle = static_cast<int>(std::lround(time / curve.interval())) + 1;
    for (int control = middle - 1; control <= middle + 1; ++control) {
      push(control, point, curve, guide);
    }
  }
  return false;
}

void TrajectoryOptimizer::push(int control, const Eigen::Vector3d& blocked_W, const Bspline& curve,
                               const Bspline& guide) {
  const int count = static_cast<int>(curve.control().size());
  if (control < kEnds || control >= count - kEnds) return;
  const Eigen::Vector3d to_guide = guide.control()[control] - blocked_W;
  const double distance = to_guide.norm();
  if (distance < kTiny) return;
  const Eigen::Vector3d direction = to_guide / distance;
  const auto is_free = [&](double depth) {
    const Eigen::Vector3d point = blocked_W + depth * direction;
    return space_.isFree(point);
  };
  double depth = 0.0;
  const double step = space_.resolution() / 4.0;
  while (depth < distance && !is_free(depth)) depth += step;
  // The curve moves less than its control points do, so they go as deep as it is, and some more.
  half_spaces_.push_back({control, curve.control()[control] + depth * direction, direction});
}

double TrajectoryOptimizer::cost(const Bspline::Points& control, double interval,
                                 Bspline::Points* gradient) const {
  std::fill(gradient->begin(), gradient->end(), Eigen::Vector3d::Zero());
  double cost = 0.0;
  addSmoothness(control, &cost, gradient);
  addClearance(control, &cost, gradient);
  addLimits(control, interval, &cost, gradient);
  return cost;
}

void TrajectoryOptimizer::addSmoothness(const Bspline::Points& control, double* cost,
                                        Bspline::Points* gradient) const {
  for (std::size_t i = 0; i + 3 < control.size(); ++i) {
    const Eigen::Vector3d jerk =
        control[i + 3] - 3.0 * control[i + 2] + 3.0 * control[i + 1] - control[i];
    *cost += kSmoothness * jerk.squaredNorm();
    const Eigen::Vector3d slope = 2.0 * kSmoothness * jerk;
    (*gradient)[i] -= slope;
    (*gradient)[i + 1] += 3.0 * slope;
    (*gradient)[i + 2] -= 3.0 * slope;
    (*gradient)[i + 3] += slope;
  }
}

void TrajectoryOptimizer::addClearance(const Bspline::Points& control, double* cost,
                                       Bspline::Points* gradient) const {
  for (const HalfSpace& half_space : half_spaces_) {
    const double missing =
        settings_.clearance -
        (control[half_space.control] - half_space.point).dot(half_space.direction);
    if (missing <= 0.0) continue;
    *cost += kClearance * missing * missing;
    (*gradient)[half_space.control] -= 2.0 * kClearance * missing * half_space.direction;
  }
}

void TrajectoryOptimizer::addLimits(const Bspline::Points& control, double interval, double* cost,
                                    Bspline::Points* gradient) const {
  for (std::size_t i = 0; i + 1 < control.size(); ++i) {
    const Eigen::Vector3d slope =
        addExcess(control[i + 1] - control[i], settings_.limits.speed * interval, cost);
    (*gradient)[i] -= slope;
    (*gradient)[i + 1] += slope;
  }
  for (std::size_t i = 0; i + 2 < control.size(); ++i) {
    const Eigen::Vector3d slope =
        addExcess(control[i] - 2.0 * control[i + 1] + control[i + 2],
                  settings_.limits.acceleration * interval * interval, cost);
    (*gradient)[i] += slope;
    (*gradient)[i + 1] -= 2.0 * slope;
    (*gradient)[i + 2] += slope;
  }
}

}  // namespace fiimap
