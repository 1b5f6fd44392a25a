#include <algorithm>
#include <array>
#include <cstring>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

[[noreturn]] void refuseCloud(const std::string& what) {
  throw InputError(DropReason::kBadCloud, what);
}

bool machineIsBigEndian() {
  const std::uint16_t one = 1;
  unsigned char first_byte = 0;
  std::memcpy(&first_byte, &one, 1);
  return first_byte == 0;
}

/// Byte of a coordinate within a point.
std::size_t offsetOf(const std::string& name, const sensor_msgs::PointCloud2& cloud) {
  const auto is_wanted = [&name](const sensor_msgs::PointField& f) { return f.name == name; };
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_wanted);
  if (field == cloud.fields.end()) refuseCloud("the cloud has no field " + name);
  if (std::any_of(field + 1, cloud.fields.end(), is_wanted)) {
    refuseCloud("the cloud has more than one field " + name);
  }
  if (field->datatype != sensor_msgs::PointField::FLOAT32) {
    refuseCloud("field " + name + " is not of type float32");
  }
  if (std::size_t{field->offset} + sizeof(float) > cloud.point_step) {
    refuseCloud("field " + name + " lies outside of point_step " +
                std::to_string(cloud.point_step));
  }
  return field->offset;
}

void requireConsistent(const sensor_msgs::PointCloud2& cloud) {
  if (static_cast<bool>(cloud.is_bigendian) != machineIsBigEndian()) {
    refuseCloud("the cloud's byte order is not the machine's");
  }
  if (std::size_t{cloud.width} * cloud.point_step > cloud.row_step) {
    refuseCloud("row_step " + std::to_string(cloud.row_step) + " is less than width * point_step");
  }
  if (std::size_t{cloud.row_step} * cloud.height > cloud.data.size()) {
    refuseCloud("data holds " + std::to_string(cloud.data.size()) +
                " bytes, less than row_step * height");
  }
}

}  // namespace

// Rows are addressed one by one: PointCloud2ConstIterator knows no padding at the end of a row.
void decodePointCloud(const sensor_msgs::PointCloud2& cloud, int pixel_step, PointScan* scan) {
  scan->points.clear();
  const std::array<std::size_t, 3> offsets = {offsetOf("x", cloud), offsetOf("y", cloud),
                                              offsetOf("z", cloud)};
  requireConsistent(cloud);
  if (cloud.width == 0 || cloud.height == 0) return;
  const bool organised = cloud.height > 1;
  const std::size_t step = organised ? std::max(pixel_step, 1) : 1;
  scan->points.reserve((cloud.width / step + 1) * (cloud.height / step + 1));
  for (std::size_t row = 0; row < cloud.height; row += step) {
    const std::uint8_t* const row_data = cloud.data.data() + row * cloud.row_step;
    for (std::size_t column = 0; column < cloud.width; column += step) {
      const std::uint8_t* const point = row_data + column * cloud.point_step;
      Eigen::Vector3f p;
      for (int axis = 0; axis < 3; ++axis) {
        std::memcpy(&p[axis], point + offsets[axis], sizeof(float));
      }
      scan->points.push_back(p);
    }
  }
}

}  // namespace fiimap
