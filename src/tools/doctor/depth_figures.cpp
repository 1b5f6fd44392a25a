#include "doctor/depth_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

constexpr int kGrid = 40;  // pixels to look at along each side

template <typename Pixel>
Pixel pixelAt(const DepthImage& image, int u, int v) {
  const auto* const row =
      static_cast<const std::uint8_t*>(image.data) + static_cast<std::size_t>(v) * image.row_bytes;
  Pixel pixel;
  std::memcpy(&pixel, row + static_cast<std::size_t>(u) * sizeof(Pixel), sizeof(Pixel));
  return pixel;
}

void count(double value, DepthFigures* figures) {
  ++figures->pixels;
  if (value <= 0.0 && std::isfinite(value)) {
    ++figures->zero;
  } else if (std::isinf(value) && value > 0.0) {
    ++figures->infinite;
  } else if (!std::isfinite(value)) {
    ++figures->not_a_number;
  } else if (figures->is_16bit && value == std::numeric_limits<std::uint16_t>::max()) {
    ++figures->saturated;
  } else {
    figures->readings.push_back(value);
  }
}

}  // namespace

void DepthFigures::add(const sensor_msgs::ImageConstPtr& message) {
  DecodedDepthImage decoded;
  try {
    decoded = decodeDepthImage(message);
  } catch (const InputError& error) {
    unreadable = error.what();
    return;
  }
  const DepthImage& image = decoded.view;
  is_16bit = image.format == DepthImage::Format::kUint16;
  const int step_u = std::max(image.width / kGrid, 1), step_v = std::max(image.height / kGrid, 1);
  // From the middle of each cell: borders are often empty.
  for (int v = step_v / 2; v < image.height; v += step_v) {
    for (int u = step_u / 2; u < image.width; u += step_u) {
      count(is_16bit ? pixelAt<std::uint16_t>(image, u, v) : pixelAt<float>(image, u, v), this);
    }
  }
}

double DepthFigures::readingShare() const {
  return pixels == 0 ? 0.0 : static_cast<double>(readings.size()) / static_cast<double>(pixels);
}

}  // namespace fiimap
