#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

DepthImage::Format formatOf(const std::string& encoding) {
  namespace enc = sensor_msgs::image_encodings;
  if (encoding == enc::TYPE_16UC1 || encoding == enc::MONO16) return DepthImage::Format::kUint16;
  if (encoding == enc::TYPE_32FC1) return DepthImage::Format::kFloat32;
  throw InputError(DropReason::kBadEncoding, "the image's encoding is '" + encoding + "'");
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
  if (image.step % pixelBytes(format) != 0) {
    refuse("step " + std::to_string(image.step) + " is not a multiple of the pixel size");
  }
  const std::size_t bytes = static_cast<std::size_t>(image.step) * image.height;
  if (image.data.size() != bytes) {
    refuse("data holds " + std::to_string(image.data.size()) + " bytes, step * height is " +
           std::to_string(bytes));
  }
}

}  // namespace

DecodedDepthImage decodeDepthImage(const sensor_msgs::ImageConstPtr& message) {
  const DepthImage::Format format = formatOf(message->encoding);
  requireConsistent(*message, format);
  cv_bridge::CvImageConstPtr image;
  try {
    image = cv_bridge::toCvShare(message);
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
