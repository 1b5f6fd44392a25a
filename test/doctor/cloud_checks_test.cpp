// Clouds that would give no map, or a wrong one.

#include <cmath>
#include <random>

#include "seen_vehicle.h"

namespace fiimap {
namespace {

SeenVehicle withLidar() {
  SeenVehicle vehicle;
  vehicle.image = [](auto*) { return !kComes; };
  vehicle.info = [](auto*) { return !kComes; };
  vehicle.cloud = [](auto*) { return kComes; };
  vehicle.static_transforms = {
      transformOf("base_link", "lidar", Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.2})};
  return vehicle;
}

TEST(CloudChecksTest, FindNothingWrongWithAGoodLidar) {
  const Diagnosis diagnosis = withLidar().diagnosis();
  expectNothingWrong(diagnosis);
  EXPECT_EQ(launchLine(diagnosis),
            "roslaunch fiimap lidar.launch points:=/points pose_source:=odometry odom:=/odom "
            "map_frame:=world");
}

TEST(CloudChecksTest, TakeShortCloudsForACameras) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    fillCloud({{2.0F, 0.0F, 0.0F}, {3.0F, 1.0F, 0.0F}}, cloud);
    return kComes;
  };
  expectContains(launchLine(vehicle.diagnosis()), "mapping.launch sensor:=points points:=/points");
}

TEST(CloudChecksTest, FindCloudsWithoutCoordinates) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    cloud->fields[2].name = "intensity";
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"no field z", "float32"});
}

TEST(CloudChecksTest, FindCloudsWithoutPoints) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    fillCloud({{std::nanf(""), 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}}, cloud);
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"No point", "finite"});
}

TEST(CloudChecksTest, FindCloudsInTheFrameOfTheMap) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    cloud->header.frame_id = "world";
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError, {"already in the frame of the map, 'world'"});
  EXPECT_TRUE(diagnosis.launch_words.empty());
}

TEST(CloudChecksTest, PreferACloudToAnImageThatMayBeNoneOfDepths) {
  SeenVehicle vehicle = withLidar();
  vehicle.image_topic = "/lidar/signal_image";
  vehicle.image = [](sensor_msgs::Image* image) {
    fillImage(3000.0, "mono16", image);
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.points, "/points");
  expectNothingWrong(diagnosis);
}

TEST(CloudChecksTest, PreferTheCloudOfTheSensor) {
  SeenVehicle vehicle = withLidar();
  SeenVehicle registered = withLidar();
  registered.cloud_topic = "/cloud_registered";
  registered.cloud = [](sensor_msgs::PointCloud2* cloud) {
    cloud->header.frame_id = "world";
    return kComes;
  };
  const Observation other = registered.observation();
  vehicle.more = [&other](Observation* seen) {
    seen->types.insert(other.types.begin(), other.types.end());
    seen->clouds.insert(other.clouds.begin(), other.clouds.end());
    seen->points.insert(other.points.begin(), other.points.end());
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.points, "/points");
  expectNothingWrong(diagnosis);
}

constexpr float kPole = 4.0F;  // m

/// Poles around the vehicle's way.
std::vector<Eigen::Vector3f> world() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-15.0F, 15.0F);
  std::vector<Eigen::Vector3f> points;
  for (int pole = 0; pole < 60; ++pole) {
    const float x = coordinate(random), y = coordinate(random);
    for (float z = 0.0F; z < kPole; z += 0.1F) points.emplace_back(x, y, z);
  }
  return points;
}

/// Ground, as a LiDAR's lines meet it: circles around the sensor.
std::vector<Eigen::Vector3f> ground() {
  std::vector<Eigen::Vector3f> points;
  for (float range = 2.0F; range < 20.0F; range *= 1.3F) {
    for (float angle = 0.0F; angle < 6.28F; angle += 0.02F) {
      points.emplace_back(range * std::cos(angle), range * std::sin(angle), -1.0F);
    }
  }
  return points;
}

TEST(CloudChecksTest, FindCloudsInTheWorldThatSayTheSensorsFrame) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    fillCloud(world(), cloud);
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kWarning,
                {"say frame 'lidar', but their points seem to be in the world", "2.9 m", "100 %"});
}

TEST(CloudChecksTest, AcceptGroundThatLooksAlikeEverywhere) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    fillCloud(ground(), cloud);
    return kComes;
  };
  expectNothingWrong(vehicle.diagnosis());
}

TEST(CloudChecksTest, AcceptCloudsThatMoveAgainstTheSensor) {
  SeenVehicle vehicle = withLidar();
  int scan = 0;
  vehicle.cloud = [&scan](sensor_msgs::PointCloud2* cloud) {
    std::vector<Eigen::Vector3f> points = world();
    for (Eigen::Vector3f& point : points) point.x() -= 0.1F * (static_cast<float>(scan) + 0.33F);
    ++scan;
    fillCloud(points, cloud);
    return kComes;
  };
  expectNothingWrong(vehicle.diagnosis());
}

TEST(CloudChecksTest, AcceptCloudsOfAVehicleThatStands) {
  SeenVehicle vehicle = withLidar();
  vehicle.cloud = [](sensor_msgs::PointCloud2* cloud) {
    fillCloud(world(), cloud);
    return kComes;
  };
  vehicle.pose = [](geometry_msgs::TransformStamped* pose) {
    pose->transform.translation.x = 0.0;
    return kComes;
  };
  expectNothingWrong(vehicle.diagnosis());
}

}  // namespace
}  // namespace fiimap
