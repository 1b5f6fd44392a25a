// Edits of the map between scans, as services and live tuning make them.
#include <gtest/gtest.h>

#include <stdexcept>

#include "fault_rig.h"

namespace fiimap {
namespace {

constexpr double kClock = 100.0;  // s

void inflateMore(Mapper* mapper) {
  MapperConfig config = mapper->config();
  config.inflation_radius = 0.5;
  config.inflation_shape = ElementShape::kCube;
  mapper->reconfigure(config);
}

TEST(MapEdit, ReadersGetTheEditedMap) {
  FaultRig rig(RigInputs::kDepth, kClock);
  rig.fly(3);
  const std::shared_ptr<const Snapshot> before = rig.state().snapshot;
  ASSERT_TRUE(before);

  EXPECT_TRUE(rig.mapping().edit(inflateMore));

  const std::shared_ptr<const Snapshot> after = rig.state().snapshot;
  EXPECT_EQ(after->info().inflation_radius, 0.5);
  EXPECT_GT(after->info().sequence, before->info().sequence);
  EXPECT_EQ(after->info().stamp_ns, before->info().stamp_ns);
  EXPECT_GT(after->count(Plane::kInflated), before->count(Plane::kInflated));
}

TEST(MapEdit, BeforeTheFirstScanThereIsStillNoMap) {
  FaultRig rig(RigInputs::kDepth, kClock);
  EXPECT_TRUE(rig.mapping().edit(inflateMore));
  EXPECT_FALSE(rig.state().snapshot);
  rig.fly(1);
  EXPECT_EQ(rig.state().snapshot->info().inflation_radius, 0.5);
}

TEST(MapEdit, WhatAnEditThrowsReachesTheCallerAndMappingGoesOn) {
  FaultRig rig(RigInputs::kDepth, kClock);
  rig.fly(1);
  const std::shared_ptr<const Snapshot> before = rig.state().snapshot;
  EXPECT_THROW(rig.mapping().edit([](Mapper*) { throw std::invalid_argument("no"); }),
               std::invalid_argument);
  EXPECT_EQ(rig.state().snapshot, before);
  rig.fly(1);
  EXPECT_NE(rig.state().snapshot, before);
}

TEST(Reconfigure, ChangesTheMapAndWhatBringsScansAndPosesTogether) {
  FaultRig rig(RigInputs::kDepth, kClock);
  rig.fly(3);
  // 0.2 s between the poses around a scan are too much.
  const auto flyOverAGap = [&rig] {
    Frame frame = rig.next();
    frame.poses = {rig.poseAt(rig.now() + 0.1)};
    rig.setNow(rig.now() + 0.1);
    rig.send(frame);
    rig.settle();
    return rig.state().totals.counters.integrated;
  };
  const std::uint64_t before = rig.state().totals.counters.integrated;
  EXPECT_EQ(flyOverAGap(), before);

  MapperConfig map = FaultRig::mapperConfig();
  map.inflation_radius = 0.5;
  NodeConfig node = FaultRig::nodeConfig(RigInputs::kDepth);
  node.max_pose_gap = 0.3;
  EXPECT_TRUE(rig.mapping().reconfigure(map, node));
  EXPECT_EQ(rig.state().snapshot->info().inflation_radius, 0.5);
  EXPECT_EQ(flyOverAGap(), before + 1);
}

TEST(Reconfigure, LeavesAllAsItWasWhenTheMapRefuses) {
  FaultRig rig(RigInputs::kDepth, kClock);
  rig.fly(3);
  const std::shared_ptr<const Snapshot> before = rig.state().snapshot;
  MapperConfig map = FaultRig::mapperConfig();
  map.resolution *= 2.0;
  NodeConfig node = FaultRig::nodeConfig(RigInputs::kDepth);
  node.time_offset = 100.0;  // with which scans would have no pose
  EXPECT_THROW(rig.mapping().reconfigure(map, node), std::invalid_argument);
  EXPECT_EQ(rig.state().snapshot, before);
  rig.fly(1);
  EXPECT_NE(rig.state().snapshot, before);
}

TEST(MapEdit, IsRefusedWhenTheThreadStops) {
  FaultRig rig(RigInputs::kDepth, kClock);
  rig.mapping().stop();
  bool called = false;
  EXPECT_FALSE(rig.mapping().edit([&](Mapper*) { called = true; }));
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace fiimap
