#include "fiimap/depth_projector.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "oracle.h"
#include "special_numbers.h"

namespace fiimap {
namespace {

constexpr PinholeIntrinsics kCamera{100.0, 110.0, 9.5, 7.25};
/// Single precision at some metres.
constexpr double kTolerance = 1e-5;

/// Every pixel counts, and rays are limited by the depth alone.
MapperConfig everyPixel() {
  MapperConfig config;
  config.pixel_step = 1;
  config.border_margin = 0;
  config.min_depth = 0.25;
  config.max_depth = 8.0;
  config.min_ray_length = 0.0;
  config.max_ray_length = 100.0;
  return config;
}

/// Owns pixels, with padding behind every row that would be seen as obstacles.
template <typename Pixel>
class Image {
 public:
  Image(int width, int height, Pixel value, int padding = 0)
      : width_(width),
        height_(height),
        stride_(width + padding),
        pixels_(stride_ * height, Pixel(1)) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) at(u, v) = value;
    }
  }
  Pixel& at(int u, int v) { return pixels_[v * stride_ + u]; }
  DepthImage view() const {
    const bool is_float = std::is_same<Pixel, float>::value;
    return {pixels_.data(), is_float ? DepthImage::Format::kFloat32 : DepthImage::Format::kUint16,
            width_, height_, stride_ * sizeof(Pixel)};
  }

 private:
  int width_, height_;
  std::size_t stride_;
  std::vector<Pixel> pixels_;
};

Eigen::Isometry3d randomPose(test::Random& random) {
  Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr(
      [&](Eigen::Index) { return test::uniformReal(random, -1.0, 1.0); });
  Eigen::Isometry3d T_W_C = Eigen::Isometry3d::Identity();
  T_W_C.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  T_W_C.translation() << test::uniformReal(random, -1e4, 1e4), test::uniformReal(random, -1e4, 1e4),
      test::uniformReal(random, -100.0, 100.0);
  return T_W_C;
}

/// eq. 3: offset of the point from the camera, in world axes.
Eigen::Vector3d backProject(double u, double v, double depth, const PinholeIntrinsics& k,
                            const Eigen::Isometry3d& T_W_C) {
  const Eigen::Vector3d point_C((u - k.cx) / k.fx * depth, (v - k.cy) / k.fy * depth, depth);
  return T_W_C.linear() * point_C;
}

/// Both lists hold the same points, in any order.
void expectSamePoints(std::vector<Eigen::Vector3f> actual, std::vector<Eigen::Vector3d> expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (const Eigen::Vector3d& point : expected) {
    const auto found = std::min_element(
        actual.begin(), actual.end(), [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
          return (a.cast<double>() - point).norm() < (b.cast<double>() - point).norm();
        });
    ASSERT_LT((found->cast<double>() - point).norm(), kTolerance) << point.transpose();
    actual.erase(found);
  }
}

TEST(PinholeIntrinsicsTest, NeedFinitePositiveFocalLengths) {
  EXPECT_TRUE(kCamera.valid());
  EXPECT_FALSE(PinholeIntrinsics().valid());
  constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()};
  for (const double bad : kBad) {
    EXPECT_FALSE((PinholeIntrinsics{bad, 1.0, 1.0, 1.0}.valid()));
    EXPECT_FALSE((PinholeIntrinsics{1.0, bad, 1.0, 1.0}.valid()));
    EXPECT_FALSE((PinholeIntrinsics{1.0, 1.0, bad, 1.0}.valid()));
    EXPECT_FALSE((PinholeIntrinsics{1.0, 1.0, 1.0, bad}.valid()));
  }
  EXPECT_FALSE((PinholeIntrinsics{-1.0, 1.0, 1.0, 1.0}.valid()));
  EXPECT_FALSE((PinholeIntrinsics{1.0, 0.0, 1.0, 1.0}.valid()));
  EXPECT_TRUE((PinholeIntrinsics{1.0, 1.0, -5.0, 0.0}.valid()));
}

class DepthProjectorStepTest : public ::testing::TestWithParam<int> {};

TEST_P(DepthProjectorStepTest, AgreesWithBackProjectionInBothFormats) {
  const int step = GetParam();
  test::Random random(61 + step);
  for (const int margin : {0, 1, 4}) {
    for (const int padding : {0, 3}) {
      SCOPED_TRACE("margin " + std::to_string(margin) + ", padding " + std::to_string(padding));
      MapperConfig config = everyPixel();
      config.pixel_step = step;
      config.border_margin = margin;
      const Eigen::Isometry3d T_W_C = randomPose(random);
      Image<std::uint16_t> millimetres(21, 15, 0, padding);
      Image<float> metres(21, 15, 0.0f, padding);
      std::vector<Eigen::Vector3d> expected;
      for (int v = 0; v < 15; ++v) {
        for (int u = 0; u < 21; ++u) {
          const int depth = test::uniformInt(random, 300, 7900);
          millimetres.at(u, v) = static_cast<std::uint16_t>(depth);
          metres.at(u, v) = static_cast<float>(depth / 1000.0);
          const bool inside = u >= margin && v >= margin && u < 21 - margin && v < 15 - margin;
          if (inside && (u - margin) % step == 0 && (v - margin) % step == 0) {
            expected.push_back(backProject(u, v, depth / 1000.0, kCamera, T_W_C));
          }
        }
      }
      for (const DepthImage& image : {millimetres.view(), metres.view()}) {
        RangeData scan;
        const ReadingCount count = DepthProjector(config).project(image, kCamera, T_W_C, &scan);
        EXPECT_EQ(scan.origin, T_W_C.translation());
        EXPECT_EQ(count.total, expected.size());
        EXPECT_EQ(count.returns, expected.size());
        EXPECT_TRUE(scan.misses.empty());
        expectSamePoints(test::toVector(scan.returns), expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, DepthProjectorStepTest, ::testing::Values(1, 2, 3, 7, 100));

TEST(DepthProjectorTest, TakesRowsOfAnyLengthInBytes) {
  constexpr std::size_t kRowBytes = 7;  // 3 pixels and one byte
  unsigned char bytes[2 * kRowBytes];
  std::memset(bytes, 0xee, sizeof(bytes));
  const std::uint16_t depth = 1000;
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 3; ++u) std::memcpy(bytes + v * kRowBytes + 2 * u, &depth, sizeof(depth));
  }
  RangeData scan;
  const DepthImage image{bytes, DepthImage::Format::kUint16, 3, 2, kRowBytes};
  DepthProjector(everyPixel()).project(image, kCamera, Eigen::Isometry3d::Identity(), &scan);
  ASSERT_EQ(scan.returns.size(), 6u);
  for (const Eigen::Vector3f& point : scan.returns) EXPECT_FLOAT_EQ(point.z(), 1.0f);
}

TEST(DepthProjectorTest, OpticalFrameLooksAlongZWithXRightAndYDown) {
  MapperConfig config = everyPixel();
  Image<std::uint16_t> image(2, 2, 0);
  image.at(1, 1) = 2000;
  RangeData scan;
  DepthProjector(config).project(image.view(), {10.0, 20.0, 0.0, 0.0},
                                 Eigen::Isometry3d::Identity(), &scan);
  ASSERT_EQ(scan.returns.size(), 1u);
  EXPECT_LT((scan.returns[0] - Eigen::Vector3f(0.2f, 0.1f, 2.0f)).norm(), kTolerance);
}

TEST(DepthProjectorTest, ScaleIsMetresPerUnit) {
  MapperConfig config = everyPixel();
  config.depth_scale = 0.0002;
  const Image<std::uint16_t> image(1, 1, 10000);
  RangeData scan;
  DepthProjector(config).project(image.view(), kCamera, Eigen::Isometry3d::Identity(), &scan);
  ASSERT_EQ(scan.returns.size(), 1u);
  EXPECT_NEAR(scan.returns[0].z(), 2.0, kTolerance);
  // Metres stay metres.
  const Image<float> metres(1, 1, 2.5f);
  DepthProjector(config).project(metres.view(), kCamera, Eigen::Isometry3d::Identity(), &scan);
  ASSERT_EQ(scan.returns.size(), 1u);
  EXPECT_NEAR(scan.returns[0].z(), 2.5, kTolerance);
}

TEST(DepthProjectorTest, FixedStepIsTheSameOnBothAxes) {
  MapperConfig config = everyPixel();
  config.pixel_step = 3;
  EXPECT_EQ(DepthProjector(config).pixelStep(kCamera), Eigen::Vector2i(3, 3));
}

TEST(DepthProjectorTest, AutomaticStepIsOneVoxelAtMaximumDepth) {
  test::Random random(62);
  MapperConfig config = everyPixel();
  config.pixel_step = 0;
  for (int round = 0; round < 1000; ++round) {
    config.resolution = test::uniformReal(random, 0.02, 0.5);
    config.max_depth = test::uniformReal(random, 2.0, 20.0);
    const PinholeIntrinsics camera{test::uniformReal(random, 50.0, 1000.0),
                                   test::uniformReal(random, 50.0, 1000.0), 1.0, 1.0};
    const Eigen::Vector2i step = DepthProjector(config).pixelStep(camera);
    const double exact[] = {camera.fx / config.max_depth * config.resolution,
                            camera.fy / config.max_depth * config.resolution};
    for (int axis = 0; axis < 2; ++axis) {
      ASSERT_GE(step[axis], 1) << "seed 62";
      ASSERT_LE(step[axis], std::max(1.0, exact[axis])) << "seed 62, no farther than a voxel";
      ASSERT_GT(step[axis], exact[axis] - 1.0) << "seed 62, no nearer than needed";
    }
  }
}

TEST(DepthProjectorTest, AutomaticStepIsExactWhereItIsWhole) {
  MapperConfig config = everyPixel();
  config.pixel_step = 0;
  for (const double resolution : {0.05, 0.1, 0.15, 0.2, 0.3}) {
    for (const double max_depth : {3.0, 5.0, 6.0, 8.0, 10.0}) {
      for (int pixels = 1; pixels <= 30; ++pixels) {
        config.resolution = resolution;
        config.max_depth = max_depth;
        // Written with few digits, as in a calibration file.
        const double focal = std::round(pixels * max_depth / resolution * 1e6) / 1e6;
        if (std::abs(focal * resolution / max_depth - pixels) > 1e-12) continue;
        const PinholeIntrinsics camera{focal, focal, 1.0, 1.0};
        EXPECT_EQ(DepthProjector(config).pixelStep(camera), Eigen::Vector2i(pixels, pixels))
            << "f " << focal << ", r " << resolution << ", d " << max_depth;
      }
    }
  }
}

TEST(DepthProjectorTest, AHugeFocalLengthLeavesOnePixel) {
  MapperConfig config = everyPixel();
  config.pixel_step = 0;
  config.border_margin = 2;
  const Image<std::uint16_t> image(9, 9, 1000);
  RangeData scan;
  const ReadingCount count = DepthProjector(config).project(image.view(), {1e300, 1e300, 4.0, 4.0},
                                                            Eigen::Isometry3d::Identity(), &scan);
  EXPECT_EQ(count.total, 1u);
}

TEST(DepthProjectorTest, AMarginWiderThanTheImageLeavesNoPixel) {
  MapperConfig config = everyPixel();
  config.border_margin = 5;
  const Image<std::uint16_t> image(10, 9, 1000);
  RangeData scan;
  scan.returns.resize(3);
  scan.misses.resize(3);
  const ReadingCount count =
      DepthProjector(config).project(image.view(), kCamera, Eigen::Isometry3d::Identity(), &scan);
  EXPECT_EQ(count.total, 0u);
  EXPECT_TRUE(scan.returns.empty()) << "is filled anew";
  EXPECT_TRUE(scan.misses.empty()) << "is filled anew";
}

}  // namespace
}  // namespace fiimap
