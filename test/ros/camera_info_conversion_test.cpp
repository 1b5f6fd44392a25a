#include <limits>

#include <gtest/gtest.h>

#include "fiimap/ros/message_conversions.h"
#include "messages.h"

namespace fiimap {
namespace {

constexpr std::uint32_t kInfoWidth = 640;
constexpr std::uint32_t kInfoHeight = 480;

sensor_msgs::CameraInfo makeInfo() {
  sensor_msgs::CameraInfo info;
  info.width = kInfoWidth;
  info.height = kInfoHeight;
  info.K = {500.0, 0.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0};
  info.P = {600.0, 0.0, 300.0, 0.0, 0.0, 610.0, 200.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

void expectIntrinsics(const PinholeIntrinsics& intrinsics, double fx, double fy, double cx,
                      double cy) {
  EXPECT_DOUBLE_EQ(intrinsics.fx, fx);
  EXPECT_DOUBLE_EQ(intrinsics.fy, fy);
  EXPECT_DOUBLE_EQ(intrinsics.cx, cx);
  EXPECT_DOUBLE_EQ(intrinsics.cy, cy);
}

TEST(DecodeCameraInfoTest, TakesTheRectifiedIntrinsics) {
  expectIntrinsics(decodeCameraInfo(makeInfo(), kInfoWidth, kInfoHeight), 600.0, 610.0, 300.0,
                   200.0);
}

TEST(DecodeCameraInfoTest, TakesTheRawOnesWhereTheOthersAreNotSet) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.P.fill(0.0);
  expectIntrinsics(decodeCameraInfo(info, kInfoWidth, kInfoHeight), 500.0, 510.0, 320.0, 240.0);
}

TEST(DecodeCameraInfoTest, ScalesToBinningAndRegionOfInterest) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.binning_x = info.binning_y = 2;
  expectIntrinsics(decodeCameraInfo(info, kInfoWidth / 2, kInfoHeight / 2), 300.0, 305.0, 150.0,
                   100.0);
  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.roi.width = 200;
  info.roi.height = 120;
  expectIntrinsics(decodeCameraInfo(info, 100, 60), 300.0, 305.0, 100.0, 80.0);
}

TEST(DecodeCameraInfoTest, RefusesUncalibratedCameras) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.P.fill(0.0);
  info.K.fill(0.0);
  expectRefusal(DropReason::kBadCameraInfo, "calibrated",
                [&info] { decodeCameraInfo(info, kInfoWidth, kInfoHeight); });
  info.P = makeInfo().P;
  info.P[5] = std::numeric_limits<double>::quiet_NaN();
  expectRefusal(DropReason::kBadCameraInfo, "calibrated",
                [&info] { decodeCameraInfo(info, kInfoWidth, kInfoHeight); });
}

TEST(DecodeCameraInfoTest, RefusesImagesOfAnotherSize) {
  expectRefusal(DropReason::kBadCameraInfo, "640 x 480",
                [] { decodeCameraInfo(makeInfo(), kInfoWidth, kInfoHeight / 2); });
  expectRefusal(DropReason::kBadCameraInfo, "320 x 480",
                [] { decodeCameraInfo(makeInfo(), kInfoWidth / 2, kInfoHeight); });
}

TEST(DistortionWarningTest, WarnsOfDistortionOnly) {
  sensor_msgs::CameraInfo info = makeInfo();
  EXPECT_EQ(distortionWarning(info), "");
  info.D = {0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(distortionWarning(info), "");
  info.D[1] = -0.1;
  EXPECT_NE(distortionWarning(info).find("rectified"), std::string::npos);
}

}  // namespace
}  // namespace fiimap
