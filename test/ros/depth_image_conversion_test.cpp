#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>
#include <boost/weak_ptr.hpp>

#include "fiimap/ros/message_conversions.h"
#include "messages.h"

namespace fiimap {
namespace {

constexpr std::uint32_t kWidth = 3;
constexpr std::uint32_t kHeight = 2;

/// Image whose pixel (u, v) holds 100 * (v + 1) + u, with `padding` bytes at the end of each row.
template <typename Pixel>
sensor_msgs::ImagePtr makeImage(const std::string& encoding, std::uint32_t padding = 0) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->encoding = encoding;
  image->width = kWidth;
  image->height = kHeight;
  image->step = kWidth * sizeof(Pixel) + padding;
  image->data.resize(image->step * kHeight, 0xEE);
  for (std::uint32_t v = 0; v < kHeight; ++v) {
    for (std::uint32_t u = 0; u < kWidth; ++u) {
      const Pixel pixel = static_cast<Pixel>(100 * (v + 1) + u);
      std::memcpy(&image->data[v * image->step + u * sizeof(Pixel)], &pixel, sizeof(Pixel));
    }
  }
  return image;
}

template <typename Pixel>
Pixel pixelOf(const DepthImage& image, std::size_t u, std::size_t v) {
  Pixel pixel;
  std::memcpy(&pixel,
              static_cast<const char*>(image.data) + v * image.row_bytes + u * sizeof(Pixel),
              sizeof(Pixel));
  return pixel;
}

template <typename Pixel>
void expectPixels(const DecodedDepthImage& decoded) {
  ASSERT_EQ(decoded.view.width, static_cast<int>(kWidth));
  ASSERT_EQ(decoded.view.height, static_cast<int>(kHeight));
  for (std::size_t v = 0; v < kHeight; ++v) {
    for (std::size_t u = 0; u < kWidth; ++u) {
      EXPECT_EQ(pixelOf<Pixel>(decoded.view, u, v), static_cast<Pixel>(100 * (v + 1) + u));
    }
  }
}

TEST(DecodeDepthImageTest, TakesThreeEncodings) {
  for (const std::string encoding : {"16UC1", "mono16"}) {
    const DecodedDepthImage decoded = decodeDepthImage(makeImage<std::uint16_t>(encoding));
    EXPECT_EQ(decoded.view.format, DepthImage::Format::kUint16);
    expectPixels<std::uint16_t>(decoded);
  }
  const DecodedDepthImage decoded = decodeDepthImage(makeImage<float>("32FC1"));
  EXPECT_EQ(decoded.view.format, DepthImage::Format::kFloat32);
  expectPixels<float>(decoded);
}

TEST(DecodeDepthImageTest, DoesNotCopyPixelsOfTheMachinesByteOrder) {
  const sensor_msgs::ImagePtr image = makeImage<std::uint16_t>("16UC1");
  EXPECT_EQ(decodeDepthImage(image).view.data, image->data.data());
}

TEST(DecodeDepthImageTest, KeepsPixelsAliveWithoutTheMessage) {
  sensor_msgs::ImagePtr image = makeImage<std::uint16_t>("16UC1");
  const boost::weak_ptr<const sensor_msgs::Image> watched = image;
  const DecodedDepthImage decoded = decodeDepthImage(image);
  image.reset();
  EXPECT_FALSE(watched.expired());
  expectPixels<std::uint16_t>(decoded);
}

TEST(DecodeDepthImageTest, SkipsPaddingAtTheEndOfRows) {
  expectPixels<std::uint16_t>(decodeDepthImage(makeImage<std::uint16_t>("16UC1", 10)));
  expectPixels<float>(decodeDepthImage(makeImage<float>("32FC1", 8)));
}

TEST(DecodeDepthImageTest, RowsMayBeginAtAnyByte) {
  for (const std::uint32_t padding : {1u, 3u}) {
    expectPixels<std::uint16_t>(decodeDepthImage(makeImage<std::uint16_t>("16UC1", padding)));
    expectPixels<float>(decodeDepthImage(makeImage<float>("32FC1", padding)));
  }
}

TEST(DecodeDepthImageTest, SwapsTheBytesOfForeignImages) {
  for (const std::uint32_t padding : {0u, 1u}) {
    sensor_msgs::ImagePtr image = makeImage<std::uint16_t>("16UC1", padding);
    image->is_bigendian = !image->is_bigendian;
    for (std::uint32_t v = 0; v < kHeight; ++v) {
      std::uint8_t* row = &image->data[v * image->step];
      for (std::uint32_t u = 0; u < kWidth; ++u) std::swap(row[2 * u], row[2 * u + 1]);
    }
    expectPixels<std::uint16_t>(decodeDepthImage(image));
  }
}

TEST(DecodeDepthImageTest, RefusesOtherEncodings) {
  for (const std::string encoding : {"rgb8", "32SC1", "16UC3", "", "nonsense"}) {
    const sensor_msgs::ImagePtr image = makeImage<std::uint16_t>(encoding);
    expectRefusal(DropReason::kBadEncoding, "'" + encoding + "'",
                  [&image] { decodeDepthImage(image); });
  }
}

TEST(DecodeDepthImageTest, RefusesSizesThatContradictEachOther) {
  const auto refuse = [](const std::string& part, void (*spoil)(sensor_msgs::Image*)) {
    const sensor_msgs::ImagePtr image = makeImage<std::uint16_t>("16UC1");
    spoil(image.get());
    expectRefusal(DropReason::kBadImage, part, [&image] { decodeDepthImage(image); });
  };
  refuse("no pixels", [](sensor_msgs::Image* image) { image->width = 0; });
  refuse("no pixels", [](sensor_msgs::Image* image) { image->height = 0; });
  refuse("step", [](sensor_msgs::Image* image) { image->step -= 2; });
  refuse("data", [](sensor_msgs::Image* image) { image->step += 1; });
  refuse("data", [](sensor_msgs::Image* image) { image->data.pop_back(); });
  refuse("data", [](sensor_msgs::Image* image) { image->data.clear(); });
  refuse("data", [](sensor_msgs::Image* image) { image->data.push_back(0); });
  // step * height is 0 in 32 bits.
  refuse("data", [](sensor_msgs::Image* image) {
    image->step = 1u << 31;
    image->data.clear();
  });
}

}  // namespace
}  // namespace fiimap
