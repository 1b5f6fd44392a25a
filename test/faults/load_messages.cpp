#include "load_messages.h"

#include <cmath>
#include <cstring>

#include <boost/make_shared.hpp>

namespace fiimap {

ImagePtr makeImage() {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->encoding = "16UC1";
  image->width = kLoadWidth;
  image->height = kLoadHeight;
  image->step = kLoadWidth * sizeof(std::uint16_t);
  image->data.resize(std::size_t{image->step} * kLoadHeight);
  for (int i = 0; i < kLoadWidth * kLoadHeight; ++i) {
    const auto depth = static_cast<std::uint16_t>(1500 + 500 * (i % kLoadWidth / 80));
    std::memcpy(&image->data[2 * static_cast<std::size_t>(i)], &depth, sizeof(depth));
  }
  return image;
}

CloudPtr makeCloud() {
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->point_step = 3 * sizeof(float);
  cloud->width = kLoadPoints;
  cloud->height = 1;
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->data.resize(cloud->row_step);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::PointField field;
    field.name = std::string("xyz").substr(axis, 1);
    field.offset = axis * sizeof(float);
    field.datatype = sensor_msgs::PointField::FLOAT32;
    cloud->fields.push_back(field);
  }
  for (int i = 0; i < kLoadPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kLoadPoints * 16.0;
    const float point[3] = {static_cast<float>(5.0 * std::cos(angle)),
                            static_cast<float>(5.0 * std::sin(angle)),
                            0.1F * static_cast<float>(16 * i / kLoadPoints - 8)};
    std::memcpy(&cloud->data[static_cast<std::size_t>(i) * sizeof(point)], point, sizeof(point));
  }
  return cloud;
}

}  // namespace fiimap
