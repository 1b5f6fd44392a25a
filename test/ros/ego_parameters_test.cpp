#include "ego_parameters.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "fiimap/ros/node_config.h"

namespace fiimap {
namespace {

struct Configuration {
  MapperConfig mapper;
  NodeConfig node;
};

/// As the mapping nodelet reads it; every name must be known to it.
Configuration configured(const ParameterMap& values) {
  Configuration c;
  EXPECT_TRUE(configure(readEgoParameters(values).mapping, &c.mapper, &c.node).empty());
  return c;
}

TEST(EgoParametersTest, DefaultsAreThoseOfTheLaunchFile) {
  const Configuration c = configured({});
  EXPECT_EQ(c.mapper.resolution, 0.1);
  EXPECT_EQ(c.mapper.inflation_shape, ElementShape::kCube);
  EXPECT_EQ(c.mapper.structuringElement().reach(), 1);
  EXPECT_EQ(c.mapper.map_mode, MapMode::kFixed);
  EXPECT_EQ(c.mapper.mapSize(), Eigen::Vector3d(40, 40, 3));
  EXPECT_EQ(c.node.map_frame, "world");
}

TEST(EgoParametersTest, HalfExtentsBecomeExtentsAndTheGroundIsTheFloor) {
  const Configuration c = configured({{"local_update_range_x", "5.5"},
                                      {"map_size_z", "4"},
                                      {"ground_height", "-1"},
                                      {"virtual_ceil_height", "2.5"}});
  EXPECT_EQ(c.mapper.local_update_range_x, 11.0);
  EXPECT_EQ(c.mapper.map_center_z, 1.0);
  EXPECT_TRUE(c.mapper.virtual_walls);
  EXPECT_EQ(c.mapper.virtual_floor, -1.0);
  EXPECT_EQ(c.mapper.virtual_ceiling, 2.5);
}

TEST(EgoParametersTest, PosesOfTheBodyGetItsHardCodedCamera) {
  const Configuration c = configured({{"pose_type", "2"}});
  EXPECT_EQ(c.node.pose_source, PoseSource::kOdometry);
  const Eigen::Isometry3d T_B_C = c.node.parameterExtrinsics();
  EXPECT_LT((T_B_C.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((T_B_C.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_EQ(T_B_C.translation().z(), -0.02);
}

TEST(EgoParametersTest, PosesOfTheCameraAreTakenAsTheyAre) {
  const Configuration c = configured({{"pose_type", "1"}});
  EXPECT_EQ(c.node.pose_source, PoseSource::kPose);
  EXPECT_TRUE(c.node.parameterExtrinsics().isApprox(Eigen::Isometry3d::Identity()));
}

TEST(EgoParametersTest, OwnNamesWinAndOthersAreReported) {
  const ParameterMap values{{"fiimap/inflation_radius", "0.3"},
                            {"obstacles_inflation", "0.1"},
                            {"show_occ_time", "true"}};
  EXPECT_EQ(configured(values).mapper.inflation_radius, 0.3);
  EXPECT_EQ(readEgoParameters(values).ignored, std::vector<std::string>{"show_occ_time"});
}

TEST(EgoParametersTest, RefusesWhatIsNoNumber) {
  EXPECT_THROW(readEgoParameters({{"fx", "wide"}}), std::invalid_argument);
  EXPECT_THROW(readEgoParameters({{"sensor", "sonar"}}), std::invalid_argument);
}

TEST(EgoParametersTest, VersionTwoHasAWindowThatFollowsTheVehicle) {
  const ParameterMap values = {{"enable_virtual_wall", "true"}, {"virtual_ceil", "2.5"},
                               {"virtual_ground", "-0.2"},      {"local_update_range_x", "7"},
                               {"local_update_range_z", "2"},   {"pose_type", "2"}};
  EXPECT_TRUE(readEgoParameters(values).is_version_2);
  EXPECT_TRUE(readEgoParameters(values).ignored.empty());
  const Configuration c = configured(values);
  EXPECT_EQ(c.mapper.map_mode, MapMode::kSliding);
  EXPECT_EQ(c.mapper.mapSize(), Eigen::Vector3d(14, 11, 4));
  EXPECT_EQ(c.mapper.local_update_range_x, 14.0);
  EXPECT_TRUE(c.mapper.virtual_walls);
  EXPECT_EQ(c.mapper.virtual_floor, -0.2);
  EXPECT_EQ(c.mapper.virtual_ceiling, 2.5);
  // As far as the window's corner.
  EXPECT_NEAR(c.mapper.max_ray_length, Eigen::Vector3d(7, 5.5, 2).norm(), 1e-9);
  EXPECT_EQ(c.node.parameterExtrinsics().translation(), Eigen::Vector3d::Zero());
}

TEST(EgoParametersTest, VersionOneIsNotTakenForVersionTwo) {
  EXPECT_FALSE(readEgoParameters({{"virtual_ceil_height", "2.5"}}).is_version_2);
}

}  // namespace
}  // namespace fiimap
