#include "doctor/cloud_figures.h"

#include <algorithm>

#include "fiimap/point_projector.h"
#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

constexpr std::size_t kPointsOfCloud = 1500;  // to look at
// A spinning LiDAR of many lines gives organised clouds too, but as wide as its turn.
constexpr std::uint32_t kMostRowsOfLidar = 128;
constexpr int kEveryPoint = 1;

}  // namespace

void CloudFigures::add(const sensor_msgs::PointCloud2& cloud) {
  PointScan scan;
  try {
    decodePointCloud(cloud, kEveryPoint, &scan);
  } catch (const InputError& error) {
    unreadable = error.what();
    return;
  }
  is_organised = cloud.height > kMostRowsOfLidar;
  last.stamp = cloud.header.stamp;
  last.points.clear();
  const std::size_t step = std::max<std::size_t>(scan.points.size() / kPointsOfCloud, 1);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f& point = scan.points[i];
    const bool is_point = point.allFinite() && !point.isZero();
    if (is_point) last.points.push_back(point);
    if (i % step != 0) continue;
    ++points;
    if (!is_point) continue;
    ++finite;
    ranges.push_back(point.norm());
  }
  if (clouds++ == 0) first = last;
}

double CloudFigures::finiteShare() const {
  return points == 0 ? 0.0 : static_cast<double>(finite) / static_cast<double>(points);
}

}  // namespace fiimap
