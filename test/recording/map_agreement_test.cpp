// Our map against an OctoMap of the same scan, counted by hand.

#include "map_agreement.h"

#include <gtest/gtest.h>

namespace fiimap {
namespace {

constexpr double kVoxelSize = 0.5;  // m

/// One point, seen from the middle of voxel 0 along x: OctoMap frees voxels 0 to 3 and, after as
/// many looks as needed, occupies voxel 4.
bench::Frame lookAt(const Eigen::Vector3f& point) {
  bench::Frame frame;
  frame.pose.T_W_S.translation() = Eigen::Vector3d(0.25, 0.25, 0.25);
  frame.points.emplace();
  frame.points->points.push_back(point);
  return frame;
}

MapperConfig config() {
  MapperConfig config;
  config.resolution = kVoxelSize;
  config.p_hit = 0.9;  // one look is enough
  return config;
}

class MapAgreementTest : public testing::Test {
 protected:
  MapAgreementTest() : theirs_(config()), grid_({20, 20, 20}) {
    ChangeSet changes;
    grid_.moveTo({-10, -10, -10}, &changes);
    theirs_.integrate(lookAt({2.0f, 0.0f, 0.0f}));
  }

  void setOurs(const VoxelIndex& v, bool occupied) {
    grid_.set(Plane::kKnown, v, true);
    grid_.set(Plane::kOccupied, v, occupied);
  }
  MapAgreement compare() {
    Snapshot::Info info;
    info.resolution = kVoxelSize;
    info.window = grid_.window();
    return compareWithOctomap(Snapshot(&grid_, info), theirs_);
  }

  bench::OctomapMap theirs_;
  SlidingGrid grid_;
};

TEST_F(MapAgreementTest, IsFullForTheSameMaps) {
  for (int x = 0; x < 4; ++x) setOurs({x, 0, 0}, false);
  setOurs({4, 0, 0}, true);
  const MapAgreement agreement = compare();
  EXPECT_EQ(agreement.overlap(Occupancy::kFree), 1.0);
  EXPECT_EQ(agreement.overlap(Occupancy::kOccupied), 1.0);
  EXPECT_EQ(agreement.ours_found, 1u);
  EXPECT_EQ(agreement.theirs_found, 1u);
}

TEST_F(MapAgreementTest, CountsWhatEachSaysOfAVoxel) {
  setOurs({0, 0, 0}, false);
  setOurs({1, 0, 0}, true);   // free to them
  setOurs({5, 0, 0}, true);   // unknown to them, beside their occupied one
  setOurs({9, 9, 9}, false);  // unknown to them
  const nlohmann::json json = toJson(compare());
  const nlohmann::json& voxels = json.at("voxels");
  EXPECT_EQ(voxels.at("free").at("free"), 1);
  EXPECT_EQ(voxels.at("occupied").at("free"), 1);
  EXPECT_EQ(voxels.at("occupied").at("unknown"), 1);
  EXPECT_EQ(voxels.at("free").at("unknown"), 1);
  EXPECT_EQ(voxels.at("unknown").at("free"), 2);
  EXPECT_EQ(voxels.at("unknown").at("occupied"), 1);
  EXPECT_EQ(voxels.at("occupied").at("occupied"), 0);
  EXPECT_DOUBLE_EQ(json.at("free_overlap"), 1.0 / 5.0);
  EXPECT_DOUBLE_EQ(json.at("occupied_overlap"), 0.0);
  EXPECT_DOUBLE_EQ(json.at("ours_found"), 0.5);
  EXPECT_DOUBLE_EQ(json.at("theirs_found"), 1.0);
}

TEST_F(MapAgreementTest, LooksInsideOurWindowOnly) {
  ChangeSet changes;
  grid_.moveTo({2, -10, -10}, &changes);
  const MapAgreement agreement = compare();
  EXPECT_EQ(agreement.theirs(Occupancy::kFree), 2u);
  EXPECT_EQ(agreement.theirs(Occupancy::kOccupied), 1u);
}

}  // namespace
}  // namespace fiimap
