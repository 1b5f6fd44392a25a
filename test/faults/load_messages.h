#pragma once

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

namespace fiimap {

using ImagePtr = boost::shared_ptr<sensor_msgs::Image>;
using CloudPtr = boost::shared_ptr<sensor_msgs::PointCloud2>;

constexpr int kLoadWidth = 640, kLoadHeight = 480;  // pixels
constexpr int kLoadPoints = 28800;

/// Steps of 1.5 to 5 m, without a stamp.
ImagePtr makeImage();
/// 16 rings at 5 m, without a stamp.
CloudPtr makeCloud();

}  // namespace fiimap
