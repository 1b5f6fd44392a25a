#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "message_faults.h"

namespace fiimap {
namespace {

using sensor_msgs::CameraInfo;
using sensor_msgs::Image;

MessageFault image(const std::function<void(Image*)>& spoil) {
  return {RigInputs::kDepth, [spoil](FaultRig* rig) {
            Frame frame = rig->next();
            spoil(&*frame.image);
            rig->send(frame);
          }};
}

MessageFault cameraInfo(const std::function<void(CameraInfo*)>& spoil) {
  return {RigInputs::kDepth, [spoil](FaultRig* rig) {
            Frame frame = rig->next();
            spoil(&*frame.info);
            rig->send(frame);
          }};
}

/// Gives each image another time than the one at which it is sent.
MessageFault stampedAt(double seconds_later) {
  return image([seconds_later](Image* i) { i->header.stamp += ros::Duration(seconds_later); });
}

void sendTwiceTheSameStamp(FaultRig* rig) {
  const Frame first = rig->next();
  Frame second = rig->next();
  second.image->header.stamp = first.image->header.stamp;
  rig->send(first);
  rig->send(second);
}

/// Images of a nearer wall, so that the map changes, in a form that spoil() gives them.
MessageFault nearerWall(const std::function<void(Image*)>& spoil) {
  return {RigInputs::kDepth, [spoil](FaultRig* rig) {
            constexpr int kFrames = 6;  // until it is seen everywhere
            for (int i = 0; i < kFrames; ++i) {
              Frame frame = rig->next();
              for (std::size_t byte = 0; byte < frame.image->data.size(); byte += 2) {
                frame.image->data[byte] = 0xDC;  // 1500 mm
                frame.image->data[byte + 1] = 0x05;
              }
              spoil(&*frame.image);
              rig->send(frame);
              rig->settle();
            }
          }};
}

void swapBytes(Image* image, std::size_t size) {
  for (std::size_t i = 0; i < image->data.size(); i += size) {
    std::reverse(&image->data[i], &image->data[i] + size);
  }
  image->is_bigendian = !image->is_bigendian;
}

void makeFloat(Image* image, float depth) {
  image->encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  image->step = image->width * sizeof(float);
  image->data.resize(std::size_t{image->step} * image->height);
  for (std::size_t i = 0; i < image->data.size(); i += sizeof(float)) {
    std::memcpy(&image->data[i], &depth, sizeof(float));
  }
}

void padRows(Image* image, std::size_t padding) {
  Image padded = *image;
  padded.step += static_cast<std::uint32_t>(padding);
  padded.data.clear();
  for (std::size_t row = 0; row < image->height; ++row) {
    const auto begin = image->data.begin() + static_cast<std::ptrdiff_t>(row * image->step);
    padded.data.insert(padded.data.end(), begin, begin + image->step);
    padded.data.insert(padded.data.end(), padding, 0xEE);
  }
  *image = padded;
}

void sendAllOtherEncodings(FaultRig* rig) {
  namespace enc = sensor_msgs::image_encodings;
  std::vector<std::string> encodings = {
      enc::RGBA8,        enc::RGB16,       enc::RGBA16,       enc::BGR8,         enc::BGRA8,
      enc::BGR16,        enc::BGRA16,      enc::MONO8,        enc::BAYER_RGGB8,  enc::BAYER_BGGR8,
      enc::BAYER_GBRG8,  enc::BAYER_GRBG8, enc::BAYER_RGGB16, enc::BAYER_BGGR16, enc::BAYER_GBRG16,
      enc::BAYER_GRBG16, enc::YUV422};
  for (const char* type : {"8U", "8S", "16U", "16S", "32S", "32F", "64F"}) {
    for (const char* channels : {"C1", "C2", "C3", "C4"}) {
      encodings.push_back(std::string(type) + channels);
    }
  }
  encodings.push_back(enc::RGB8);
  for (const std::string& encoding : encodings) {
    if (encoding == enc::TYPE_16UC1 || encoding == enc::TYPE_32FC1) continue;
    Frame frame = rig->next();
    frame.image->encoding = encoding;
    rig->send(frame);
    rig->settle();
  }
}

void sendBodyFrameImages(FaultRig* rig) {
  // The image is said to be taken in the body's frame, whose z axis points up.
  for (int i = 0; i < 6; ++i) {
    Frame frame = rig->next();
    frame.image->header.frame_id = "body";
    rig->send(frame);
    rig->settle();
  }
}

MessageFault withoutHeight() {
  return {RigInputs::kDepth, [](FaultRig* rig) {
            Frame frame = rig->next();
            frame.info->height = frame.image->height = 0;
            rig->send(frame);
          }};
}

MessageFault sizeOverflow() {
  return {RigInputs::kDepth, [](FaultRig* rig) {
            Frame frame = rig->next();
            frame.info->height = frame.image->height = 2;
            frame.image->step = 1u << 31;
            frame.image->data.clear();
            rig->send(frame);
          }};
}

MessageFaults cameraInfoFaults() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  return {
      {"info_missing",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          Frame frame = rig->next();
          frame.info.reset();
          rig->send(frame);
        },
        true}},
      {"info_late",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          Frame frame = rig->next();
          Frame late;
          std::swap(late.info, frame.info);
          rig->send(frame);
          rig->send(late);
        },
        true}},
      {"info_zeros", cameraInfo([](CameraInfo* info) { info->K.fill(0.0); })},
      {"info_not_finite",
       {RigInputs::kDepth,
        [=](FaultRig* rig) {
          for (const int entry : {0, 2, 4, 5}) {
            for (const float value : {nan, infinity}) {
              Frame frame = rig->next();
              frame.info->K[entry] = value;
              rig->send(frame);
              rig->settle();
            }
          }
        }}},
      {"info_negative", cameraInfo([](CameraInfo* info) { info->K[4] *= -1.0; })},
      {"info_other_size", cameraInfo([](CameraInfo* info) {
         info->width = 640;
         info->height = 480;
       })},
      {"info_binning", cameraInfo([](CameraInfo* info) {
         info->binning_x = info->binning_y = std::numeric_limits<std::uint32_t>::max();
       })},
      {"info_distorted",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          Frame frame = rig->next();
          frame.info->D = {0.1, 0.0, 0.0, 0.0, 0.0};
          rig->send(frame);
        },
        true}},
      {"info_changes",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          Frame frame = rig->next();
          frame.info.reset();
          frame.image->width /= 2;
          frame.image->height /= 2;
          frame.image->step /= 2;
          frame.image->data.resize(frame.image->data.size() / 4);
          rig->send(frame);
        }}},
  };
}

}  // namespace

MessageFaults imageFaults() {
  MessageFaults faults = {
      {"image_encodings", {RigInputs::kDepth, sendAllOtherEncodings}},
      {"image_encoding_unknown",
       {RigInputs::kDepth,
        [](FaultRig* rig) {
          for (const char* encoding : {"nonsense", "16uc1", ""}) {
            Frame frame = rig->next();
            frame.image->encoding = encoding;
            rig->send(frame);
            rig->settle();
          }
        }}},
      {"image_step_small", image([](Image* i) { --i->step; })},
      {"image_step_large", image([](Image* i) { ++i->step; })},
      {"image_size_overflow", sizeOverflow()},
      {"image_data_short", image([](Image* i) { i->data.pop_back(); })},
      {"image_data_long", image([](Image* i) { i->data.push_back(0); })},
      {"image_data_none", image([](Image* i) { i->data.clear(); })},
      {"image_width_zero", image([](Image* i) { i->width = 0; })},
      {"image_height_zero", withoutHeight()},
      {"image_swapped_uint16", nearerWall([](Image* i) { swapBytes(i, 2); })},
      {"image_swapped_float", nearerWall([](Image* i) {
         makeFloat(i, 1.5F);
         swapBytes(i, sizeof(float));
       })},
      {"image_rows_padded", nearerWall([](Image* i) { padRows(i, 3); })},
      {"image_zero_stamp", image([](Image* i) { i->header.stamp = ros::Time(); })},
      {"image_same_stamp", {RigInputs::kDepth, sendTwiceTheSameStamp}},
      {"image_late", stampedAt(-FaultRig::kPeriod - 0.5)},
      {"image_future", stampedAt(100.0)},
      {"image_past", stampedAt(-100.0)},
      {"image_stamp_end_of_time", image([](Image* i) { i->header.stamp = ros::TIME_MAX; })},
      {"image_unknown_frame", image([](Image* i) { i->header.frame_id = "elsewhere"; })},
      {"image_no_frame", image([](Image* i) { i->header.frame_id.clear(); })},
      {"image_body_frame", {RigInputs::kDepth, sendBodyFrameImages, true}},
  };
  faults.merge(cameraInfoFaults());
  return faults;
}

MessageFaults depthFaults() {
  const auto of16Bits = [](std::uint8_t byte) {
    return image([byte](Image* i) { std::fill(i->data.begin(), i->data.end(), byte); });
  };
  const auto ofMetres = [](float depth) {
    return image([depth](Image* i) { makeFloat(i, depth); });
  };
  using Limits = std::numeric_limits<float>;
  return {
      {"depth_zero", of16Bits(0x00)},
      {"depth_saturated", of16Bits(0xFF)},
      {"depth_nan", ofMetres(Limits::quiet_NaN())},
      {"depth_negative", image([](Image* i) {
         makeFloat(i, -2.0F);
         const float minus_infinity = -Limits::infinity();
         std::memcpy(i->data.data(), &minus_infinity, sizeof(float));
       })},
      {"depth_infinite", ofMetres(Limits::infinity())},
      {"depth_denormal", ofMetres(Limits::denorm_min())},
      {"depth_huge", ofMetres(1e38F)},
      {"depth_near", ofMetres(0.1F)},
  };
}

}  // namespace fiimap
