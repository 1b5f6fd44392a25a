#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

namespace enc = sensor_msgs::image_encodings;

DepthImage::Format formatOf(const std::string& encoding) {
  if (!isDepthEncoding(encoding)) {
    throw InputError(DropReason::kBadEncoding, "the image's encoding is '" + encoding + "'");
  }
  return encoding == enc::TYPE_32FC1 ? DepthImage::Format::kFloat32 : DepthImage::Format::kUint16;
}

std::size_t pixelBytes(DepthImage::Format format) {
  return format == DepthImage::Format::kUint16 ? sizeof(std::uint16_t) : sizeof(float);
}

void requireConsistent(const sensor_msgs::Image& image, DepthImage::Format format) {
  const auto refuse = [](const std::string& what) {
    throw InputError(DropReason::kBadImage, what);
  };
  if (image.width == 0 || image.height == 0) refuse("the image has no pixels");
  const std::size_t row_bytes = image.width * pixelBytes(format);
  if (image.step < row_bytes) {
    refuse("step " + std::to_string(image.step) + " is less than the " + std::to_string(row_bytes) +
           " bytes of a row");
  }
  const std::size_t bytes = static_cast<std::size_t>(image.step) * image.height;
  if (image.data.size() != bytes) {
    refuse("data holds " + std::to_string(image.data.size()) + " bytes, step * height is " +
           std::to_string(bytes));
  }
}

/// Rows that begin at any byte, copied side by side: OpenCV wants whole pixels.
sensor_msgs::ImageConstPtr withoutPadding(const sensor_msgs::Image& image, std::size_t row_bytes) {
  const auto packed = boost::make_shared<sensor_msgs::Image>();
  packed->header = image.header;
  packed->height = image.height;
  packed->width = image.width;
  packed->encoding = image.encoding;
  packed->is_bigendian = image.is_bigendian;
  packed->step = static_cast<std::uint32_t>(row_bytes);
  packed->data.reserve(row_bytes * image.height);
  for (std::size_t v = 0; v < image.height; ++v) {
    const auto row = image.data.begin() + static_cast<std::ptrdiff_t>(v * image.step);
    packed->data.insert(packed->data.end(), row, row + static_cast<std::ptrdiff_t>(row_bytes));
  }
  return packed;
}

}  // namespace

bool isDepthEncoding(const std::string& encoding) {
  return encoding == enc::TYPE_16UC1 || encoding == enc::MONO16 || encoding == enc::TYPE_32FC1;
}

DecodedDepthImage decodeDepthImage(const sensor_msgs::ImageConstPtr& message) {
  const DepthImage::Format format = formatOf(message->encoding);
  requireConsistent(*message, format);
  const std::size_t pixel_bytes = pixelBytes(format);
  cv_bridge::CvImageConstPtr image;
  try {
    image = cv_bridge::toCvShare(message->step % pixel_bytes == 0
                                     ? message
                                     : withoutPadding(*message, message->width * pixel_bytes));
  } catch (const std::exception& error) {
    throw InputError(DropReason::kBadImage, error.what());
  }
  DecodedDepthImage decoded;
  decoded.view.data = image->image.data;
  decoded.view.format = format;
  decoded.view.width = image->image.cols;
  decoded.view.height = image->image.rows;
  decoded.view.row_bytes = image->image.step[0];
  decoded.pixels = std::make_shared<const cv_bridge::CvImageConstPtr>(image);
  return decoded;
}

}  // namespace fiimap
