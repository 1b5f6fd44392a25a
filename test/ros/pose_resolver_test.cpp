#include "fiimap/ros/pose_resolver.h"

#include <cmath>

#include <gtest/gtest.h>

#include "messages.h"

namespace fiimap {
namespace {

using State = ResolvedPose::State;

constexpr double kPoseTolerance = 1e-6;
const double kQuarterTurn = std::acos(0.0);

nav_msgs::Odometry odometryAt(double seconds, double x, double yaw = 0.0) {
  const geometry_msgs::TransformStamped transform = transformAt(seconds, x, yaw);
  nav_msgs::Odometry odometry;
  odometry.header = transform.header;
  odometry.child_frame_id = transform.child_frame_id;
  odometry.pose.pose.position.x = x;
  odometry.pose.pose.orientation = transform.transform.rotation;
  return odometry;
}

geometry_msgs::PoseStamped poseAt(double seconds, double x) {
  geometry_msgs::PoseStamped pose;
  pose.header = transformAt(seconds, x).header;
  pose.pose.position.x = x;
  pose.pose.orientation.w = 1.0;
  return pose;
}

tf2_msgs::TFMessage tf(const geometry_msgs::TransformStamped& transform) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  return message;
}

/// Of the one sensor that its configuration describes.
class Resolver : public PoseResolver {
 public:
  explicit Resolver(const NodeConfig& config) : PoseResolver(config), sensor_(config) {}
  ResolvedPose at(const std::string& frame, const ros::Time& stamp) const {
    return PoseResolver::at(sensor_, frame, stamp);
  }

 private:
  SensorConfig sensor_;
};

/// Camera 0.5 m in front of the body.
void addCamera(PoseResolver* resolver, double yaw = 0.0) {
  resolver->addTf(tf(transformAt(0.0, 0.5, yaw, "body", "camera")), true);
}

NodeConfig parameterExtrinsics() {
  NodeConfig config;
  config.extrinsics = ExtrinsicsSource::kParameter;
  config.extrinsic_translation = {0.5, 0.0, 0.0};
  return config;
}

void expectPose(const ResolvedPose& pose, const Eigen::Vector3d& sensor_W,
                const Eigen::Vector3d& vehicle_W) {
  ASSERT_EQ(pose.state, State::kFound) << pose.why.text();
  EXPECT_TRUE(pose.T_W_S.translation().isApprox(sensor_W, kPoseTolerance))
      << pose.T_W_S.translation().transpose();
  EXPECT_TRUE(pose.T_W_B.translation().isApprox(vehicle_W, kPoseTolerance))
      << pose.T_W_B.translation().transpose();
}

void expectMissing(const ResolvedPose& pose, State state, DropReason reason) {
  EXPECT_EQ(pose.state, state);
  EXPECT_STREQ(nameOf(pose.why.reason), nameOf(reason));
  EXPECT_FALSE(pose.why.detail.empty());
}

TEST(PoseResolverTest, PutsTheSensorOnTheBodyByParameter) {
  Resolver resolver(parameterExtrinsics());
  resolver.add(odometryAt(0.0, 2.0, kQuarterTurn));
  expectPose(resolver.at("any", at(0.0)), {2.0, 0.5, 0.0}, {2.0, 0.0, 0.0});
}

TEST(PoseResolverTest, PutsTheSensorOnTheBodyByTf) {
  Resolver resolver{NodeConfig()};
  resolver.add(odometryAt(0.0, 2.0, kQuarterTurn));
  expectMissing(resolver.at("camera", at(0.0)), State::kPending, DropReason::kNoExtrinsics);
  addCamera(&resolver);
  expectPose(resolver.at("camera", at(0.0)), {2.0, 0.5, 0.0}, {2.0, 0.0, 0.0});
}

TEST(PoseResolverTest, TakesPoseAndTransformMessages) {
  NodeConfig config;
  config.pose_source = PoseSource::kTransform;
  Resolver by_transform(config);
  by_transform.add(transformAt(0.0, 2.0));
  addCamera(&by_transform);
  expectPose(by_transform.at("camera", at(0.0)), {2.5, 0.0, 0.0}, {2.0, 0.0, 0.0});

  config.pose_source = PoseSource::kPose;
  config.body_frame = "body";
  Resolver by_pose(config);
  by_pose.add(poseAt(0.0, 2.0));
  addCamera(&by_pose);
  expectPose(by_pose.at("camera", at(0.0)), {2.5, 0.0, 0.0}, {2.0, 0.0, 0.0});
}

TEST(PoseResolverTest, TheBodyFrameParameterWinsOverTheMessage) {
  NodeConfig config;
  config.body_frame = "imu";
  Resolver resolver(config);
  resolver.add(odometryAt(0.0, 2.0));
  resolver.addTf(tf(transformAt(0.0, 0.25, 0.0, "imu", "camera")), true);
  expectPose(resolver.at("camera", at(0.0)), {2.25, 0.0, 0.0}, {2.0, 0.0, 0.0});
}

TEST(PoseResolverTest, FollowsTfWithAndWithoutABody) {
  NodeConfig config;
  config.pose_source = PoseSource::kTf;
  for (const std::string body : {"", "body"}) {
    config.body_frame = body;
    Resolver resolver(config);
    addCamera(&resolver);
    expectMissing(resolver.at("camera", at(0.0)), State::kPending, DropReason::kPoseTimeout);
    resolver.addTf(tf(transformAt(0.0, 2.0)), false);
    resolver.addTf(tf(transformAt(0.05, 3.0)), false);
    const Eigen::Vector3d vehicle_W(body.empty() ? 3.0 : 2.5, 0.0, 0.0);
    expectPose(resolver.at("camera", at(0.025)), {3.0, 0.0, 0.0}, vehicle_W);
    expectMissing(resolver.at("camera", at(-0.1)), State::kImpossible, DropReason::kPoseTooOld);
    expectMissing(resolver.at("camera", at(0.1)), State::kPending, DropReason::kPoseTimeout);
  }
}

TEST(PoseResolverTest, FollowsTheBodyInTfWithExtrinsicsByParameter) {
  NodeConfig config = parameterExtrinsics();
  config.pose_source = PoseSource::kTf;
  config.body_frame = "body";
  Resolver resolver(config);
  resolver.addTf(tf(transformAt(0.0, 2.0)), false);
  expectPose(resolver.at("not in tf", at(0.0)), {2.5, 0.0, 0.0}, {2.0, 0.0, 0.0});
}

TEST(PoseResolverTest, SaysWhyThereIsNoPose) {
  Resolver resolver(parameterExtrinsics());
  expectMissing(resolver.at("s", at(0.0)), State::kPending, DropReason::kPoseTimeout);
  resolver.add(odometryAt(0.0, 0.0));
  resolver.add(odometryAt(0.2, 0.0));
  expectMissing(resolver.at("s", at(-1.0)), State::kImpossible, DropReason::kPoseTooOld);
  expectMissing(resolver.at("s", at(0.1)), State::kImpossible, DropReason::kPoseGap);
  expectMissing(resolver.at("s", at(0.3)), State::kPending, DropReason::kPoseTimeout);
}

TEST(PoseResolverTest, BlamesRefusedPosesUntilAGoodOneComes) {
  Resolver resolver(parameterExtrinsics());
  resolver.add(transformAt(0.0, 0.0, 0.0, "odom"));
  expectMissing(resolver.at("s", at(0.0)), State::kPending, DropReason::kFrameMismatch);
  resolver.add(odometryAt(0.0, std::nan("")));
  expectMissing(resolver.at("s", at(0.0)), State::kPending, DropReason::kBadPose);
  EXPECT_EQ(resolver.refusedPoses(), 2u);
  resolver.add(odometryAt(0.0, 1.0));
  expectMissing(resolver.at("s", at(0.1)), State::kPending, DropReason::kPoseTimeout);
}

TEST(PoseResolverTest, TakesFrameIdsWithASlash) {
  Resolver resolver(parameterExtrinsics());
  resolver.add(transformAt(0.0, 1.0, 0.0, "/world"));
  EXPECT_EQ(resolver.at("s", at(0.0)).state, State::kFound);
}

TEST(PoseResolverTest, KnowsWhetherTheSensorIsRotatedOnTheBody) {
  Resolver straight{NodeConfig()}, turned{NodeConfig()};
  addCamera(&straight);
  addCamera(&turned, kQuarterTurn);
  for (Resolver* resolver : {&straight, &turned}) {
    resolver->add(odometryAt(0.0, 0.0, kQuarterTurn));
    EXPECT_EQ(resolver->at("camera", at(0.0)).sensor_axes_like_body, resolver == &straight);
  }
}

TEST(PoseResolverTest, EachSensorHasItsOwnPlaceOnTheBody) {
  SensorConfig left = parameterExtrinsics(), from_tf;
  left.extrinsic_translation = {0.0, 0.25, 0.0};
  PoseResolver resolver(parameterExtrinsics());
  resolver.add(odometryAt(0.0, 2.0, kQuarterTurn));
  addCamera(&resolver);
  expectPose(resolver.at(left, "any", at(0.0)), {1.75, 0.0, 0.0}, {2.0, 0.0, 0.0});
  expectPose(resolver.at(from_tf, "camera", at(0.0)), {2.0, 0.5, 0.0}, {2.0, 0.0, 0.0});
}

}  // namespace
}  // namespace fiimap
