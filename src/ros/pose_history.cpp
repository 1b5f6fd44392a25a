#include "fiimap/ros/pose_history.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <vector>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

constexpr double kQuaternionTolerance = 0.05;  // of quaternions
constexpr double kMaxPoseRate = 1000.0;        // Hz; with a faster source the history is shorter
constexpr unsigned int kMinCachedPoses = 100;

}  // namespace

Eigen::Isometry3d decodeTransform(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  const Eigen::Vector3d translation(t.x, t.y, t.z);
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    throw InputError(DropReason::kBadPose, "a pose is not finite");
  }
  if (std::abs(rotation.norm() - 1.0) > kQuaternionTolerance) {
    throw InputError(DropReason::kBadPose,
                     "a pose's quaternion has norm " + std::to_string(rotation.norm()));
  }
  Eigen::Isometry3d decoded = Eigen::Isometry3d::Identity();
  decoded.linear() = rotation.normalized().toRotationMatrix();
  decoded.translation() = translation;
  return decoded;
}

PoseHistory::PoseHistory(double history, double max_gap) : history_(history), max_gap_(max_gap) {
  clear();
}

void PoseHistory::clear() {
  const auto size = static_cast<unsigned int>(std::ceil(history_ * kMaxPoseRate));
  cache_ = std::make_unique<Cache>(std::max(size, kMinCachedPoses));
}

void PoseHistory::add(const geometry_msgs::TransformStamped& pose) {
  if (pose.header.stamp.isZero()) throw InputError(DropReason::kZeroStamp, "a pose has no stamp");
  decodeTransform(pose.transform);
  // With a time of receipt the event does not ask the clock, which offline tools do not have.
  cache_->add(Cache::EventType(boost::make_shared<const geometry_msgs::TransformStamped>(pose),
                               nullptr, pose.header.stamp));
}

PoseAtStamp PoseHistory::at(const ros::Time& stamp) const {
  PoseAtStamp pose;
  if (empty() || stamp > newest()) return pose;
  if (stamp < oldest() || secondsBetween(stamp, newest()) > history_) {
    pose.lookup = PoseLookup::kTooOld;
    return pose;
  }
  const auto around = cache_->getSurroundingInterval(stamp, stamp);
  const auto& before = *around.front();
  const auto& after = *around.back();
  pose.gap = secondsBetween(before.header.stamp, after.header.stamp);
  if (pose.gap > max_gap_) {
    pose.lookup = PoseLookup::kGap;
    return pose;
  }
  const Eigen::Isometry3d T_W_B0 = decodeTransform(before.transform);
  const Eigen::Isometry3d T_W_B1 = decodeTransform(after.transform);
  const double ratio = pose.gap > 0.0 ? secondsBetween(before.header.stamp, stamp) / pose.gap : 0.0;
  const Eigen::Quaterniond q0(T_W_B0.linear()), q1(T_W_B1.linear());
  pose.T_W_B.linear() = q0.slerp(ratio, q1).toRotationMatrix();
  pose.T_W_B.translation() = (1.0 - ratio) * T_W_B0.translation() + ratio * T_W_B1.translation();
  pose.body_frame = after.child_frame_id;
  pose.lookup = PoseLookup::kFound;
  return pose;
}

}  // namespace fiimap
