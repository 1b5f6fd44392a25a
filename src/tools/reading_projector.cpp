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
    : pixel_step_(pixel_step),
      depth_projector_(withStep(config, pixel_step)),
      point_projector_(config) {}

ReadingCount ReadingProjector::project(const SynchronizedScan& scan, RangeData* range) {
  if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&scan.message)) {
    const DecodedDepthImage decoded = decodeDepthImage(*image);
    return depth_projector_.project(decoded.view, scan.intrinsics, scan.pose.T_W_S, range);
  }
  const auto& cloud = std::get<sensor_msgs::PointCloud2ConstPtr>(scan.message);
  decodePointCloud(*cloud, pixel_step_, &points_);
  return point_projector_.project(points_, scan.pose.T_W_S, range);
}

}  // namespace fiimap
