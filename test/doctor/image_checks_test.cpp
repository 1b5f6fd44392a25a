// Depth images that would give no map, or a wrong one.

#include <cmath>
#include <limits>

#include "seen_vehicle.h"

namespace fiimap {
namespace {

TEST(ImageChecksTest, FindNothingWrongWithAGoodCamera) {
  const Diagnosis diagnosis = SeenVehicle().diagnosis();
  expectNothingWrong(diagnosis);
  EXPECT_EQ(diagnosis.trial.usable, diagnosis.trial.scans);
  EXPECT_EQ(diagnosis.trial.scans, 30u);
}

TEST(ImageChecksTest, MissCameraInfo) {
  SeenVehicle vehicle;
  vehicle.info = [](auto*) { return !kComes; };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kError,
                {"/camera/depth/image_rect_raw has no camera_info", "none elsewhere"});
  EXPECT_TRUE(diagnosis.launch_words.empty());
}

TEST(ImageChecksTest, TellWhereOtherCameraInfoIs) {
  SeenVehicle vehicle;
  vehicle.info_topic = "/camera/color/camera_info";
  vehicle.info = [](sensor_msgs::CameraInfo* info) {
    info->header.frame_id = "colour";
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"no camera_info beside it", "/camera/color/camera_info (80 x 60, frame 'colour')",
                 "--camera-info TOPIC"});
}

TEST(ImageChecksTest, TakeCameraInfoOfTheSameFrameFromElsewhere) {
  SeenVehicle vehicle;
  vehicle.info_topic = "/driver/info";
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectNothingWrong(diagnosis);
  expectFinding(diagnosis, Severity::kNote, {"not beside it", "/driver/info"});
  expectContains(launchLine(diagnosis), "camera_info:=/driver/info");
}

TEST(ImageChecksTest, RefuseCameraInfoOfAnotherSize) {
  SeenVehicle vehicle;
  vehicle.info = [](sensor_msgs::CameraInfo* info) {
    info->width = 640;
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"describes an image of 640 x 60, the depth image is 80 x 60"});
}

TEST(ImageChecksTest, WonderAtCameraInfoOfAnotherFrame) {
  SeenVehicle vehicle;
  vehicle.info = [](sensor_msgs::CameraInfo* info) {
    info->header.frame_id = "colour_optical";
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kWarning,
                {"is of frame 'colour_optical'", "'camera_optical'"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(ImageChecksTest, PassOnWhatTheNodeSaysOfDistortion) {
  SeenVehicle vehicle;
  vehicle.info = [](sensor_msgs::CameraInfo* info) {
    info->D = {0.1, 0.0, 0.0, 0.0, 0.0};
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kWarning, {"distortion"});
}

Diagnosis withImagesOf(double value, const std::string& encoding) {
  SeenVehicle vehicle;
  vehicle.image = [=](sensor_msgs::Image* image) {
    fillImage(value, encoding, image);
    return kComes;
  };
  return vehicle.diagnosis();
}

TEST(ImageChecksTest, FindImagesWithoutDepth) {
  expectFinding(withImagesOf(0.0, "16UC1"), Severity::kError, {"No pixel of", "100 % are 0"});
  expectFinding(withImagesOf(65535.0, "mono16"), Severity::kError, {"No pixel of", "100 % 65535"});
  expectFinding(withImagesOf(std::nan(""), "32FC1"), Severity::kError,
                {"No pixel of", "100 % NaN"});
}

TEST(ImageChecksTest, OnlyWonderAtImagesOfTheSky) {
  const Diagnosis diagnosis = withImagesOf(std::numeric_limits<double>::infinity(), "32FC1");
  expectFinding(diagnosis, Severity::kWarning, {"met anything", "100 % infinite"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(ImageChecksTest, WonderAtFewReadings) {
  SeenVehicle vehicle;
  vehicle.image = [](sensor_msgs::Image* image) {
    fillImage(0.0, "16UC1", image);
    // The lowest of 60 rows: 3000.
    for (std::size_t i = image->step * 59; i < image->data.size(); i += 2) {
      image->data[i] = 0xB8;
      image->data[i + 1] = 0x0B;
    }
    return kComes;
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  expectFinding(diagnosis, Severity::kWarning, {"Only 2 % of the pixels"});
  EXPECT_EQ(diagnosis.count(Severity::kError), 0u);
}

TEST(ImageChecksTest, FindTheUnitOf16BitImages) {
  const Diagnosis tenths = withImagesOf(30000.0, "16UC1");  // 3 m in 0.1 mm
  expectFinding(tenths, Severity::kError,
                {"another unit", "median 30000 units", "30.00 m", "depth_scale: 0.0001", "3.00 m"});
  expectContains(launchLine(tenths), "parameters:={depth_scale: 0.0001}");

  const Diagnosis metres = withImagesOf(3.0, "16UC1");
  expectFinding(metres, Severity::kError, {"another unit", "median 3 units", "depth_scale: 1"});
  expectContains(launchLine(metres), "parameters:={depth_scale: 1}");
}

TEST(ImageChecksTest, BelieveADepthScaleThatFits) {
  SeenVehicle vehicle;
  vehicle.image = [](sensor_msgs::Image* image) {
    fillImage(30000.0, "16UC1", image);
    return kComes;
  };
  DoctorWishes wishes;
  wishes.parameters["depth_scale"] = "0.0001";
  const Diagnosis diagnosis = vehicle.diagnosis(wishes);
  expectNothingWrong(diagnosis);
  expectContains(launchLine(diagnosis), "depth_scale: 0.0001");
}

TEST(ImageChecksTest, FindMillimetresIn32BitImages) {
  const Diagnosis diagnosis = withImagesOf(3000.0, "32FC1");
  expectFinding(diagnosis, Severity::kError, {"wrong unit", "3000.00 m", "millimetres"});
  EXPECT_TRUE(diagnosis.launch_words.empty());  // no parameter repairs it
  expectNothingWrong(withImagesOf(3.0, "32FC1"));
}

TEST(ImageChecksTest, TellColourFromDepth) {
  SeenVehicle vehicle;
  vehicle.image_topic = "/camera/color/image_raw";
  vehicle.image = [](sensor_msgs::Image* image) {
    image->encoding = "rgb8";
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"no depth images", "/camera/color/image_raw (rgb8)"});
  DoctorWishes wishes;
  wishes.depth_images = {"/camera/color/image_raw"};
  expectFinding(vehicle.diagnosis(wishes), Severity::kError, {"'rgb8'", "no depth image"});
}

TEST(ImageChecksTest, TellHowToUnpackCompressedDepth) {
  SeenVehicle vehicle;
  vehicle.image = [](auto*) { return !kComes; };
  vehicle.more = [](Observation* seen) {
    seen->types["/camera/depth/image_raw/compressedDepth"] = "sensor_msgs/CompressedImage";
  };
  expectFinding(vehicle.diagnosis(), Severity::kError,
                {"compressed form only", "republish compressedDepth in:=/camera/depth/image_raw"});
}

TEST(ImageChecksTest, NameTopicsThatAreSilent) {
  SeenVehicle vehicle;
  vehicle.image = [](auto*) { return !kComes; };
  vehicle.more = [](Observation* seen) { seen->types["/camera/depth"] = "sensor_msgs/Image"; };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"/camera/depth (silent)"});
}

TEST(ImageChecksTest, FindSizesThatContradict) {
  SeenVehicle vehicle;
  vehicle.image = [](sensor_msgs::Image* image) {
    image->data.pop_back();
    return kComes;
  };
  expectFinding(vehicle.diagnosis(), Severity::kError, {"cannot be read", "step * height"});
}

TEST(ImageChecksTest, ChooseAmongSeveral) {
  SeenVehicle vehicle;
  const Observation one = vehicle.observation();
  vehicle.more = [&one](Observation* seen) {
    seen->images["/a/image"] = one.images.begin()->second;
    seen->depth["/a/image"] = one.depth.begin()->second;
    seen->types["/a/image"] = "sensor_msgs/Image";
  };
  const Diagnosis diagnosis = vehicle.diagnosis();
  EXPECT_EQ(diagnosis.setup.depth_image, "/camera/depth/image_rect_raw");  // has camera_info
  expectFinding(diagnosis, Severity::kNote, {"Of several depth images", "/a/image"});
  DoctorWishes wishes;
  wishes.depth_images = {"/a/image"};
  EXPECT_EQ(vehicle.diagnosis(wishes).setup.depth_image, "/a/image");
}

}  // namespace
}  // namespace fiimap
