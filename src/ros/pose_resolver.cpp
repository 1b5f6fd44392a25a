#include "fiimap/ros/pose_resolver.h"

#include <limits>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/pose_messages.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

std::string secondsText(const ros::Time& from, const ros::Time& to) {
  return std::to_string(secondsBetween(from, to)) + " s";
}

ResolvedPose unresolved(ResolvedPose::State state, const Drop& why) {
  ResolvedPose resolved;
  resolved.state = state;
  resolved.why = why;
  return resolved;
}

ResolvedPose withoutPose(PoseLookup lookup, const std::string& detail) {
  using State = ResolvedPose::State;
  switch (lookup) {
    case PoseLookup::kTooOld:
      return unresolved(State::kImpossible, {DropReason::kPoseTooOld, detail});
    case PoseLookup::kGap:
      return unresolved(State::kImpossible, {DropReason::kPoseGap, detail});
    default:
      return unresolved(State::kPending, {DropReason::kPoseTimeout, detail});
  }
}

ResolvedPose resolved(const Eigen::Isometry3d& T_W_S, const Eigen::Isometry3d& T_W_B, double gap) {
  ResolvedPose pose;
  pose.state = ResolvedPose::State::kFound;
  pose.T_W_S = T_W_S;
  pose.T_W_B = T_W_B;
  pose.gap = gap;
  return pose;
}

bool isNearIdentity(const Eigen::Matrix3d& rotation) {
  constexpr double kTolerance = 0.05;  // rad
  return Eigen::AngleAxisd(rotation).angle() < kTolerance;
}

constexpr double kAnyGap = std::numeric_limits<double>::infinity();

}  // namespace

PoseResolver::PoseResolver(const NodeConfig& config)
    : config_(config),
      history_(config.pose_history, config.max_pose_gap),
      tree_(config.pose_history) {}

void PoseResolver::reconfigure(const NodeConfig& config) {
  config_ = config;
  history_.setMaxGap(config.max_pose_gap);
}

void PoseResolver::add(const nav_msgs::Odometry& odometry) { add(toTransform(odometry)); }

void PoseResolver::add(const geometry_msgs::PoseStamped& pose) { add(toTransform(pose)); }

void PoseResolver::add(const geometry_msgs::TransformStamped& transform) {
  try {
    const std::string frame = plainFrame(transform.header.frame_id);
    if (frame != config_.map_frame) {
      throw InputError(
          DropReason::kFrameMismatch,
          "poses are in frame '" + frame + "', map_frame is '" + config_.map_frame + "'");
    }
    history_.add(transform);
    refused_.reset();
  } catch (const InputError& error) {
    refuse(error.drop());
  }
}

void PoseResolver::refuse(const Drop& why) {
  refused_ = why;
  ++refused_poses_;
}

void PoseResolver::addTf(const tf2_msgs::TFMessage& transforms, bool is_static,
                         const ros::Time& other) {
  for (const auto& transform : transforms.transforms) tree_.add(transform, is_static, other);
}

void PoseResolver::clear() {
  history_.clear();
  tree_.clear();
  refused_.reset();
}

ResolvedPose PoseResolver::at(const SensorConfig& sensor, const std::string& sensor_frame,
                              const ros::Time& stamp) const {
  if (config_.pose_source == PoseSource::kTf) {
    return sensor.extrinsics == ExtrinsicsSource::kTf ? sensorFromTf(sensor_frame, stamp)
                                                      : bodyFromTf(sensor, sensor_frame, stamp);
  }
  const PoseAtStamp body = history_.at(stamp);
  if (body.lookup != PoseLookup::kFound) return withoutMessage(body, stamp);
  const bool named = !config_.body_frame.empty();
  return sensorOnBody(sensor, body.T_W_B, body.gap,
                      named ? config_.body_frame : plainFrame(body.body_frame), sensor_frame,
                      stamp);
}

ResolvedPose PoseResolver::withoutMessage(const PoseAtStamp& pose, const ros::Time& stamp) const {
  switch (pose.lookup) {
    case PoseLookup::kTooOld:
      return withoutPose(pose.lookup, "poses are known from " +
                                          secondsText(stamp, history_.oldest()) + " to " +
                                          secondsText(stamp, newestPose()) + " after the scan");
    case PoseLookup::kGap:
      return withoutPose(pose.lookup,
                         "the poses around the scan are " + std::to_string(pose.gap) + " s apart");
    default:
      break;
  }
  if (refused_) return unresolved(ResolvedPose::State::kPending, *refused_);
  return withoutPose(pose.lookup, history_.empty()
                                      ? "no pose was received"
                                      : "the newest pose is " + secondsText(newestPose(), stamp) +
                                            " older than the scan");
}

ResolvedPose PoseResolver::sensorOnBody(const SensorConfig& sensor, const Eigen::Isometry3d& T_W_B,
                                        double gap, const std::string& body_frame,
                                        const std::string& sensor_frame,
                                        const ros::Time& stamp) const {
  Eigen::Isometry3d T_B_S = sensor.parameterExtrinsics();
  if (sensor.extrinsics == ExtrinsicsSource::kTf) {
    const TransformAtStamp extrinsics = tree_.at(body_frame, sensor_frame, stamp, kAnyGap);
    if (extrinsics.lookup != PoseLookup::kFound) {
      const bool pending = extrinsics.lookup == PoseLookup::kNotYet;
      return unresolved(pending ? ResolvedPose::State::kPending : ResolvedPose::State::kImpossible,
                        {DropReason::kNoExtrinsics, "no transform from sensor frame '" +
                                                        sensor_frame + "' to body frame '" +
                                                        body_frame + "': " + extrinsics.why});
    }
    T_B_S = extrinsics.T_target_source;
  }
  ResolvedPose pose = resolved(T_W_B * T_B_S, T_W_B, gap);
  pose.sensor_axes_like_body = isNearIdentity(T_B_S.linear());
  return pose;
}

ResolvedPose PoseResolver::bodyFromTf(const SensorConfig& sensor, const std::string& sensor_frame,
                                      const ros::Time& stamp) const {
  const TransformAtStamp body =
      tree_.at(config_.map_frame, config_.body_frame, stamp, config_.max_pose_gap);
  if (body.lookup != PoseLookup::kFound) return withoutPose(body.lookup, body.why);
  return sensorOnBody(sensor, body.T_target_source, body.gap, config_.body_frame, sensor_frame,
                      stamp);
}

ResolvedPose PoseResolver::sensorFromTf(const std::string& sensor_frame,
                                        const ros::Time& stamp) const {
  const TransformAtStamp sensor =
      tree_.at(config_.map_frame, sensor_frame, stamp, config_.max_pose_gap);
  if (sensor.lookup != PoseLookup::kFound) return withoutPose(sensor.lookup, sensor.why);
  const Eigen::Isometry3d& T_W_S = sensor.T_target_source;
  if (config_.body_frame.empty()) return resolved(T_W_S, T_W_S, sensor.gap);

  const TransformAtStamp body =
      tree_.at(config_.map_frame, config_.body_frame, stamp, config_.max_pose_gap);
  if (body.lookup != PoseLookup::kFound) return withoutPose(body.lookup, body.why);
  const Eigen::Isometry3d& T_W_B = body.T_target_source;
  ResolvedPose pose = resolved(T_W_S, T_W_B, sensor.gap);
  pose.sensor_axes_like_body = isNearIdentity(T_W_B.linear().transpose() * T_W_S.linear());
  return pose;
}

}  // namespace fiimap
