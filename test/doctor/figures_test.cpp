// Figures of readings against messages made by hand.

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "doctor/cloud_figures.h"
#include "doctor/depth_figures.h"
#include "seen_vehicle.h"

namespace fiimap {
namespace {

TEST(DepthFiguresTest, CountEveryKindOfPixel) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = 4;
  image->height = 2;
  fillImage(0.0, "32FC1", image.get());
  const float inf = std::numeric_limits<float>::infinity();
  const float pixels[8] = {0.0F, std::nanf(""), inf, -inf, 2.0F, 3.0F, -1.0F, 2.5F};
  std::memcpy(image->data.data(), pixels, sizeof(pixels));
  DepthFigures figures;
  figures.add(image);
  EXPECT_EQ(figures.pixels, 8u);
  EXPECT_EQ(figures.zero, 2u);
  EXPECT_EQ(figures.not_a_number, 2u);
  EXPECT_EQ(figures.infinite, 1u);
  EXPECT_EQ(figures.readings, (std::vector<double>{2.0, 3.0, 2.5}));
  EXPECT_DOUBLE_EQ(figures.readingShare(), 3.0 / 8.0);
}

TEST(DepthFiguresTest, LookAtAGridOfLargeImages) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = 640;
  image->height = 480;
  fillImage(1234.0, "16UC1", image.get());
  DepthFigures figures;
  figures.add(image);
  EXPECT_GT(figures.pixels, 1000u);
  EXPECT_LT(figures.pixels, 2000u);
  EXPECT_EQ(figures.readings, std::vector<double>(figures.pixels, 1234.0));
}

TEST(CloudFiguresTest, CountPointsThatAreSome) {
  sensor_msgs::PointCloud2 cloud;
  fillCloud({{3.0F, 4.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, {std::nanf(""), 1.0F, 1.0F}}, &cloud);
  CloudFigures figures;
  figures.add(cloud);
  EXPECT_EQ(figures.points, 3u);
  EXPECT_EQ(figures.finite, 1u);
  EXPECT_EQ(figures.ranges, std::vector<double>{5.0});
  cloud.fields.pop_back();
  figures.add(cloud);
  EXPECT_EQ(figures.unreadable, "the cloud has no field z");
}

}  // namespace
}  // namespace fiimap
