#include "kinect.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace fiimap {
namespace {

constexpr double kFocalLength = 525.0;  // pixels
constexpr double kBaseline = 0.075;     // m
constexpr double kNearest = 0.45;       // m
constexpr double kFarthest = 8.5;       // m
constexpr double kDropout = 0.1;        // share of the pixels: dark and glossy things
constexpr double kFlattest = 1.22;      // rad between ray and normal: 70 degrees
constexpr float kMetresPerMillimetre = 1e-3f;
// x and y are rounded to this, m: they take less room then.
constexpr float kSidewaysStep = 1.0f / 1024.0f;

// The layout of a point in the recording, bytes.
constexpr std::uint32_t kPointStep = 32;
constexpr std::uint32_t kColourOffset = 16;

sim::CameraConfig cameraConfig() {
  sim::CameraConfig config;
  config.image_width = 640;
  config.image_height = 480;
  config.horizontal_fov = 2.0 * std::atan(config.image_width / 2.0 / kFocalLength);
  config.min_range = kNearest;
  config.max_range = kFarthest;
  return config;
}

sim::NoiseConfig noiseConfig() {
  sim::NoiseConfig config;
  config.depth_noise = true;
  config.baseline = kBaseline;
  config.disparity_step = 1.0 / 8.0;  // pixels
  config.dropout = kDropout;
  config.max_incidence = kFlattest;
  return config;
}

sensor_msgs::PointField field(const std::string& name, std::uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  return field;
}

sensor_msgs::PointCloud2 emptyCloud(int width, int height) {
  sensor_msgs::PointCloud2 cloud;
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.fields = {field("x", 0), field("y", 4), field("z", 8), field("rgb", kColourOffset)};
  cloud.point_step = kPointStep;
  cloud.row_step = cloud.width * kPointStep;
  cloud.is_dense = false;
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * cloud.height);
  return cloud;
}

float rounded(double metres) {
  return std::round(static_cast<float>(metres) / kSidewaysStep) * kSidewaysStep;
}

}  // namespace

Kinect::Kinect(std::uint64_t seed)
    : config_(cameraConfig()),
      camera_(config_),
      noise_(noiseConfig(), config_.focalLength(), seed) {}

Eigen::Isometry3d Kinect::T_V_C() {
  Eigen::Isometry3d T_V_C = Eigen::Isometry3d::Identity();
  T_V_C.matrix().topRows<3>() << 0.971048, -0.120915, 0.206023, 0.00114049,  //
      0.15701, 0.973037, -0.168959, 0.0450936,                               //
      -0.180038, 0.196415, 0.96385, 0.0430765;
  return T_V_C;
}

sensor_msgs::PointCloud2 Kinect::scan(const sim::RayScene& scene, const Eigen::Isometry3d& T_W_C,
                                      std::uint64_t number, int pixel_step) {
  sim::DepthFrame frame = camera_.render(scene, T_W_C, true);
  noise_.apply(number, &frame);
  const std::vector<std::uint16_t> millimetres =
      sim::toMillimetres(frame, config_.min_range, config_.max_range);
  sensor_msgs::PointCloud2 cloud = emptyCloud((frame.width + pixel_step - 1) / pixel_step,
                                              (frame.height + pixel_step - 1) / pixel_step);
  std::uint8_t* out = cloud.data.data();
  for (int v = 0; v < frame.height; v += pixel_step) {
    for (int u = 0; u < frame.width; u += pixel_step, out += kPointStep) {
      const std::uint16_t depth = millimetres[static_cast<std::size_t>(v) * frame.width + u];
      Eigen::Vector3f point = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
      if (depth != 0) {
        const float z = static_cast<float>(depth) * kMetresPerMillimetre;
        const Eigen::Vector2d xy =
            z * (Eigen::Vector2d(u, v) - config_.center()) / config_.focalLength();
        point = {rounded(xy.x()), rounded(xy.y()), z};
      }
      std::memcpy(out, point.data(), sizeof(point));
    }
  }
  return cloud;
}

}  // namespace fiimap
