// Clouds with any fields, sizes, steps and points.

#include <boost/make_shared.hpp>

#include "scan_feed.h"

namespace fiimap::fuzz {
namespace {

constexpr std::uint32_t kStart = 1600000000;  // s
constexpr std::uint32_t kPointBytes = 12;

sensor_msgs::PointField takeField(int index, ByteSource* bytes) {
  const char* const names[] = {"x", "y", "z"};
  sensor_msgs::PointField field;
  const bool is_plain = bytes->integer(0, 15) != 0;
  field.name = is_plain ? names[index % 3] : bytes->text(4);
  field.offset = is_plain ? index * sizeof(float) : bytes->anySize(0, 32);
  field.datatype = is_plain ? sensor_msgs::PointField::FLOAT32 : bytes->take<std::uint8_t>();
  field.count = is_plain ? 1 : bytes->anySize(0, 3);
  return field;
}

sensor_msgs::PointCloud2Ptr takeCloud(ByteSource* bytes) {
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header.frame_id = bytes->text(8);
  const int fields = bytes->integer(0, 7) == 0 ? bytes->integer(0, 5) : 3;
  for (int i = 0; i < fields; ++i) cloud->fields.push_back(takeField(i, bytes));
  cloud->is_bigendian = bytes->integer(0, 15) == 0 ? bytes->take<std::uint8_t>() : 0;
  cloud->width = bytes->anySize(0, 16);
  cloud->height = bytes->anySize(0, 4);
  cloud->point_step = bytes->integer(0, 3) != 0 ? kPointBytes : bytes->anySize(0, 40);
  cloud->row_step =
      bytes->integer(0, 3) != 0 ? cloud->point_step * cloud->width : bytes->anySize(0, 400);
  constexpr std::size_t kMostBytes = 4096;
  const std::size_t size = std::size_t{cloud->row_step} * cloud->height;
  cloud->data = bytes->bytes(std::min(size, kMostBytes));
  if (bytes->integer(0, 3) != 0) cloud->data.resize(std::min(size, kMostBytes));
  return cloud;
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fiimap::fuzz;
  ByteSource bytes(data, size);
  fiimap::MapperConfig config = smallMap();
  config.pixel_step = bytes.integer(0, 3);
  config.beyond_max_depth = static_cast<fiimap::ReadingPolicy>(bytes.integer(0, 1));
  ScanFeed feed(config, nodeWithoutTf(fiimap::SensorKind::kPoints));
  for (std::uint32_t i = 0; i < 4 && !bytes.empty(); ++i) {
    const ros::Time stamp(kStart + i, 0);
    feed.synchronizer().add(fiimap::PoseMessage(poseAt(stamp)));
    const sensor_msgs::PointCloud2Ptr cloud = takeCloud(&bytes);
    cloud->header.stamp = stamp;
    feed.add(sensor_msgs::PointCloud2ConstPtr(cloud));
  }
  feed.finish();
  return 0;
}
