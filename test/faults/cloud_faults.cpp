#include <cstring>
#include <limits>
#include <utility>

#include "message_faults.h"

namespace fiimap {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();

MessageFault cloud(const std::function<void(PointCloud2*)>& spoil) {
  return {RigInputs::kPoints, [spoil](FaultRig* rig) {
            Frame frame = rig->next();
            spoil(&*frame.cloud);
            rig->send(frame);
          }};
}

/// Fills all coordinates with the given values in turn.
void fill(PointCloud2* cloud, const std::vector<float>& values) {
  std::size_t next = 0;
  for (std::size_t point = 0; point < cloud->data.size(); point += cloud->point_step) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float value = values[next++ % values.size()];
      std::memcpy(&cloud->data[point + axis * sizeof(float)], &value, sizeof(value));
    }
  }
}

void sendEveryOtherType(FaultRig* rig) {
  for (const int type :
       {PointField::INT8 + 0, PointField::UINT8 + 0, PointField::INT16 + 0, PointField::UINT16 + 0,
        PointField::INT32 + 0, PointField::UINT32 + 0, PointField::FLOAT64 + 0, 0, 9, 255}) {
    Frame frame = rig->next();
    frame.cloud->fields[2].datatype = static_cast<std::uint8_t>(type);
    rig->send(frame);
    rig->settle();
  }
}

void sendTwoCloudsOfOneStamp(FaultRig* rig) {
  const Frame first = rig->next();
  Frame second = rig->next();
  second.cloud->header.stamp = first.cloud->header.stamp;
  rig->send(first);
  rig->send(second);
}

void makeEmpty(PointCloud2* cloud) {
  cloud->width = cloud->row_step = 0;
  cloud->data.clear();
}

/// Points of the wall, side by side up to 10 m to the left and to the right.
void makeLarge(PointCloud2* cloud) {
  constexpr std::uint32_t kPoints = 10'000'000;
  cloud->point_step = 3 * sizeof(float);
  cloud->width = kPoints;
  cloud->row_step = kPoints * cloud->point_step;
  cloud->data.assign(cloud->row_step, 0);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const float point[3] = {FaultRig::kWall, 20.0F * i / kPoints - 10.0F, 0.001F * (i % 1000)};
    std::memcpy(&cloud->data[std::size_t{i} * cloud->point_step], point, sizeof(point));
  }
}

}  // namespace

MessageFaults cloudFaults() {
  using Limits = std::numeric_limits<float>;
  return {
      {"cloud_no_fields", cloud([](PointCloud2* c) { c->fields.clear(); })},
      {"cloud_no_z", cloud([](PointCloud2* c) { c->fields.pop_back(); })},
      {"cloud_doubled_field", cloud([](PointCloud2* c) {
         c->fields.push_back(c->fields[0]);
         c->fields.back().offset += 4;
       })},
      {"cloud_float64", cloud([](PointCloud2* c) { c->fields[0].datatype = PointField::FLOAT64; })},
      {"cloud_integers", {RigInputs::kPoints, sendEveryOtherType}},
      {"cloud_offset_beyond", cloud([](PointCloud2* c) { c->fields[2].offset = 13; })},
      {"cloud_offset_overflow", cloud([](PointCloud2* c) { c->fields[1].offset = kMax; })},
      {"cloud_point_step_zero", cloud([](PointCloud2* c) { c->point_step = 0; })},
      {"cloud_row_step_small", cloud([](PointCloud2* c) { c->row_step = 1; })},
      {"cloud_row_step_large", cloud([](PointCloud2* c) { ++c->row_step; })},
      {"cloud_width_overflow", cloud([](PointCloud2* c) { c->width = 1u << 28; })},
      {"cloud_height_overflow", cloud([](PointCloud2* c) {
         c->row_step = 1u << 31;
         c->height = 2;
       })},
      {"cloud_data_short", cloud([](PointCloud2* c) { c->data.pop_back(); })},
      {"cloud_big_endian", cloud([](PointCloud2* c) { c->is_bigendian = !c->is_bigendian; })},
      {"cloud_not_finite", cloud([](PointCloud2* c) {
         fill(c, {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), 1.0F});
       })},
      {"cloud_far", cloud([](PointCloud2* c) { fill(c, {1e15F}); })},
      {"cloud_beyond_numbers", cloud([](PointCloud2* c) { fill(c, {1e38F}); })},
      {"cloud_empty", cloud(makeEmpty)},
      {"cloud_rows_of_nothing", cloud([](PointCloud2* c) {
         makeEmpty(c);
         c->height = kMax;
       })},
      {"cloud_ten_million",
       {RigInputs::kPoints,
        [](FaultRig* rig) {
          Frame frame = rig->next();
          makeLarge(&*frame.cloud);
          rig->send(frame);
        },
        true}},
      {"cloud_zero_stamp", cloud([](PointCloud2* c) { c->header.stamp = ros::Time(); })},
      {"cloud_same_stamp", {RigInputs::kPoints, sendTwoCloudsOfOneStamp}},
  };
}

}  // namespace fiimap
