#include "reading_projector.h"

#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

MapperConfig withStep(MapperConfig config, int pixel_step) {
  config.pixel_step = pixel_step;
  return config;
}

}  // namespace

ReadingProjector::ReadingProjector(const MapperConfig& config, int pixel_step)
    : pixel_step_(pixel_step) {
  for (std::size_t sensor = 0; sensor < config.sensorCount(); ++sensor) {
    const MapperConfig own = withStep(config.withOnly(sensor), pixel_step);
    projectors_.push_back({DepthProjector(own), PointProjector(own)});
  }
}

ReadingCount ReadingProjector::project(const SynchronizedScan& scan, RangeData* range) {
  if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&scan.message)) {
    const DecodedDepthImage decoded = decodeDepthImage(*image);
    return projectors_.at(scan.sensor)
        .depth.project(decoded.view, scan.intrinsics, scan.pose.T_W_S, range);
  }
  const auto& cloud = std::get<sensor_msgs::PointCloud2ConstPtr>(scan.message);
  decodePointCloud(*cloud, pixel_step_, &points_);
  return projectors_.at(scan.sensor).points.project(points_, scan.pose.T_W_S, range);
}

}  // namespace fiimap
