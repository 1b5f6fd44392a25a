#include "two_sensors.h"

#include "doctor/mount.h"

namespace fiimap {

void addScans(const Observation& other, Observation* seen) {
  seen->types.insert(other.types.begin(), other.types.end());
  seen->images.insert(other.images.begin(), other.images.end());
  seen->depth.insert(other.depth.begin(), other.depth.end());
  seen->infos.insert(other.infos.begin(), other.infos.end());
  seen->clouds.insert(other.clouds.begin(), other.clouds.end());
  seen->points.insert(other.points.begin(), other.points.end());
}

TwoCameras::TwoCameras() {
  left.image_topic = "/left/depth/image_rect_raw";
  left.info_topic = "/left/depth/camera_info";
  left.image = setFrame<sensor_msgs::Image>("left_optical");
  left.info = setFrame<sensor_msgs::CameraInfo>("left_optical");
  const Eigen::Quaterniond to_the_left(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()));
  vehicle.static_transforms.push_back(
      transformOf("base_link", "left_optical", to_the_left * opticalRotation(), {0.0, 0.1, 0.0}));
}

Diagnosis TwoCameras::diagnosis(const DoctorWishes& wishes) {
  const Observation of_left = left.observation();
  vehicle.more = [&](Observation* seen) {
    addScans(of_left, seen);
    more(seen);
  };
  return vehicle.diagnosis(wishes);
}

SeenVehicle withCameraAndLidar() {
  SeenVehicle vehicle;
  vehicle.cloud = [](auto*) { return kComes; };
  vehicle.cloud_topic = "/velodyne_points";
  vehicle.static_transforms.push_back(
      transformOf("base_link", "lidar", Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.3}));
  return vehicle;
}

}  // namespace fiimap
