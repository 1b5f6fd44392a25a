// Depth images of any encoding, size, step, byte order and content, with any camera_info.

#include <boost/make_shared.hpp>

#include "scan_feed.h"

namespace fiimap::fuzz {
namespace {

constexpr std::uint32_t kStart = 1600000000;  // s
constexpr int kMostSide = 8;                  // pixels

std::string takeEncoding(ByteSource* bytes) {
  const char* const known[] = {"16UC1", "mono16", "32FC1", "mono8", "bgr8", "64FC1", "bayer_rggb8"};
  const int choice = bytes->integer(0, 8);
  return choice < 7 ? known[choice] : bytes->text(12);
}

std::uint32_t pixelBytes(const std::string& encoding) { return encoding == "32FC1" ? 4 : 2; }

sensor_msgs::ImageConstPtr takeImage(ByteSource* bytes) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.frame_id = bytes->text(8);
  image->encoding = takeEncoding(bytes);
  image->is_bigendian = bytes->integer(0, 3) == 0 ? bytes->take<std::uint8_t>() : 0;
  image->width = bytes->anySize(0, kMostSide);
  image->height = bytes->anySize(0, kMostSide);
  const bool is_plain = bytes->integer(0, 3) != 0;
  image->step = is_plain ? image->width * pixelBytes(image->encoding) : bytes->anySize(0, 64);
  const std::size_t size = std::size_t{image->step} * image->height;
  constexpr std::size_t kMostBytes = 4096;
  image->data = bytes->bytes(std::min(size, kMostBytes));
  const bool completes = size <= kMostBytes && bytes->integer(0, 3) != 0;
  if (completes || bytes->empty()) image->data.resize(std::min(size, kMostBytes));
  return image;
}

sensor_msgs::CameraInfoConstPtr takeCameraInfo(const sensor_msgs::Image& image, ByteSource* bytes) {
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  const bool fits = bytes->integer(0, 7) != 0;
  info->width = fits ? image.width : bytes->anySize(0, kMostSide);
  info->height = fits ? image.height : bytes->anySize(0, kMostSide);
  info->K = {bytes->anyDouble(1.0, 10.0),
             0.0,
             bytes->anyDouble(0.0, 8.0),
             0.0,
             bytes->anyDouble(1.0, 10.0),
             bytes->anyDouble(0.0, 8.0),
             0.0,
             0.0,
             1.0};
  if (bytes->flag()) {
    info->P = {bytes->anyDouble(0.0, 9.0),
               0.0,
               bytes->anyDouble(0.0, 8.0),
               0.0,
               0.0,
               bytes->anyDouble(0.0, 9.0),
               bytes->anyDouble(0.0, 8.0),
               0.0,
               0.0,
               0.0,
               1.0,
               0.0};
  }
  if (bytes->integer(0, 7) == 0) {
    info->binning_x = bytes->anySize(0, 4);
    info->binning_y = bytes->anySize(0, 4);
    info->roi.width = bytes->anySize(0, kMostSide);
    info->roi.height = bytes->anySize(0, kMostSide);
    info->roi.x_offset = bytes->anySize(0, kMostSide);
    info->roi.y_offset = bytes->anySize(0, kMostSide);
  }
  if (bytes->integer(0, 7) == 0) info->D = {bytes->anyDouble(-1.0, 1.0)};
  return info;
}

MapperConfig takeMap(ByteSource* bytes) {
  MapperConfig config = smallMap();
  const auto takePolicy = [bytes] { return static_cast<ReadingPolicy>(bytes->integer(0, 1)); };
  config.invalid_depth = takePolicy();
  config.infinite_depth = takePolicy();
  config.beyond_max_depth = takePolicy();
  config.pixel_step = bytes->integer(0, 3);
  config.border_margin = bytes->integer(0, 2);
  return config;
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fiimap::fuzz;
  ByteSource bytes(data, size);
  ScanFeed feed(takeMap(&bytes), nodeWithoutTf(fiimap::SensorKind::kDepth));
  for (std::uint32_t i = 0; i < 4 && !bytes.empty(); ++i) {
    const ros::Time stamp(kStart + i, 0);
    feed.synchronizer().add(fiimap::PoseMessage(poseAt(stamp)));
    auto image = boost::make_shared<sensor_msgs::Image>(*takeImage(&bytes));
    image->header.stamp = stamp;
    feed.synchronizer().add(takeCameraInfo(*image, &bytes));
    feed.add(sensor_msgs::ImageConstPtr(image));
  }
  feed.finish();
  return 0;
}
