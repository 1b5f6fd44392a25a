#include "optimizer.h"

bool FakeOptimizer::isFree(const Eigen::MatrixXd& points) {
  bool dangerous = false;
  for (int i = 1; i < points.cols(); ++i) {
    const double length = (points.col(i) - points.col(i - 1)).norm();
    const double step_size = map_->getResolution() / max(length, 1e-6) / 2;
    bool occ = map_->getInflateOccupancy(points.col(i));
    for (double a = 1.0; a >= 0.0 && !occ; a -= step_size) {
      occ = map_->getInflateOccupancy(a * points.col(i - 1) + (1 - a) * points.col(i));
    }
    dangerous |= map_->getInflateOccupancy(evaluate(points, i - 0.5));
    if (occ) return false;
  }
  return !dangerous;
}

Eigen::VectorXd FakeOptimizer::evaluate(const Eigen::MatrixXd& points, double t) {
  const int i = floor(t);
  return points.col(i) + (t - i) * (points.col(i + 1) - points.col(i));
}
