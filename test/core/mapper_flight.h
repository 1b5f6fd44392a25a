#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/mapper.h"
#include "mapper_model.h"
#include "oracle.h"

namespace fiimap::test {

/// A vehicle that flies through a world of few obstacles, so that it sees them again and again.
class Flight {
 public:
  static constexpr double kStampStep = 1e-9;  // s, most often

  explicit Flight(Random* random) : random_(*random), position_(randomPoint(1.0)) {
    for (int i = 0; i < 25; ++i) obstacles_.push_back(position_ + randomPoint(kSight));
  }

  ScanPose next() {
    const bool jumps = chance(random_, 0.03);
    position_ += randomPoint(jumps ? 500.0 : chance(random_, 0.6) ? 0.2 : 1.0);
    for (Eigen::Vector3d& obstacle : obstacles_) {
      const bool is_out_of_sight = (obstacle - position_).norm() > 2.0 * kSight;
      if (is_out_of_sight || chance(random_, 0.02)) obstacle = position_ + randomPoint(kSight);
    }
    ScanPose pose;
    pose.vehicle_W = position_;
    pose.T_W_S.translation() = position_ + randomPoint(0.3);
    pose.T_W_S.linear() =
        Eigen::AngleAxisd(uniformReal(random_, -3.0, 3.0), randomPoint(1.0).normalized())
            .toRotationMatrix();
    stamp_ += chance(random_, 0.05) ? uniformInt(random_, 2, 40) : 1;
    pose.stamp_ns = stamp_;
    return pose;
  }

  /// World points around the obstacles, and some that are somewhere else or nowhere near.
  std::vector<Eigen::Vector3d> look() {
    std::vector<Eigen::Vector3d> points_W;
    for (const Eigen::Vector3d& obstacle : obstacles_) {
      if (chance(random_, 0.8)) points_W.push_back(obstacle + randomPoint(0.1));
      if (chance(random_, 0.2)) points_W.push_back(position_ + randomPoint(15.0));
    }
    return points_W;
  }

 private:
  static constexpr double kSight = 2.5;  // m

  Eigen::Vector3d randomPoint(double reach) {
    return Eigen::Vector3d::NullaryExpr(
        [&](Eigen::Index) { return uniformReal(random_, -reach, reach); });
  }

  Random& random_;
  Eigen::Vector3d position_;
  std::vector<Eigen::Vector3d> obstacles_;
  std::int64_t stamp_ = 0;
};

inline Eigen::Vector3f inSensorFrame(const ScanPose& pose, const Eigen::Vector3d& point_W) {
  return (pose.T_W_S.inverse() * point_W).cast<float>();
}

/// Lets the mapper slide without seeing anything, then drops the points that rounding decides.
inline std::vector<Eigen::Vector3d> exactPoints(const MapperModel& model, const ScanPose& pose,
                                                const VoxelBox& window,
                                                std::vector<Eigen::Vector3d> points_W) {
  const std::vector<bool> is_exact = model.exactRays(pose, points_W, window);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    if (is_exact[i]) points_W[kept++] = points_W[i];
  }
  points_W.resize(kept);
  return points_W;
}

inline PointScan asScan(const ScanPose& pose, const std::vector<Eigen::Vector3d>& points_W) {
  PointScan scan;
  for (const Eigen::Vector3d& p : points_W) scan.points.push_back(inSensorFrame(pose, p));
  return scan;
}

}  // namespace fiimap::test
