#include "fiimap/ros/scan_decoder.h"

#include <chrono>
#include <stdexcept>

#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/steady_time.h"

namespace fiimap {

ScanReport ScanDecoder::integrate(const SynchronizedScan& scan, Mapper* mapper) {
  const SteadyTime start = std::chrono::steady_clock::now();
  // What the mapper itself refuses after decoding can only be the pose.
  try {
    if (const auto* image = std::get_if<sensor_msgs::ImageConstPtr>(&scan.message)) {
      const DecodedDepthImage decoded = decodeDepthImage(*image);
      decode_time_ms_ = millisecondsSince(start);
      return mapper->integrate(decoded.view, scan.intrinsics, scan.pose, scan.sensor);
    }
    const auto& cloud = std::get<sensor_msgs::PointCloud2ConstPtr>(scan.message);
    decodePointCloud(*cloud, mapper->config().readingOf(scan.sensor).pixel_step, &points_);
    decode_time_ms_ = millisecondsSince(start);
    return mapper->integrate(points_, scan.pose, scan.sensor);
  } catch (const std::invalid_argument& error) {
    throw InputError(DropReason::kBadPose, error.what());
  }
}

}  // namespace fiimap
