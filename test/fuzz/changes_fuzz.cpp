// Messages of ~changes with any numbers and bytes, between good ones.

#include <fiimap/MapChanges.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "../ros/changes_oracle.h"
#include "byte_source.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/map_changes.h"
#include "fiimap/ros/map_changes_reader.h"

namespace fiimap::fuzz {
namespace {

using test::ElementDefinition;

constexpr double kMemoryLimit = 4.0;  // MB
constexpr int kResolutionMm = 250;

/// A small map that moves, and what is at the far end of it.
class Link {
 public:
  explicit Link(ByteSource* bytes) : bytes_(*bytes), mapper_(takeConfig()), reader_(kMemoryLimit) {}

  void operate() {
    change();
    const std::shared_ptr<const Snapshot> now = mapper_.snapshot();
    const bool is_keyframe = !sent_ || bytes_.integer(0, 7) == 0;
    const MapChanges message = toMapChanges(*now, is_keyframe ? nullptr : sent_.get(), "map");
    sent_ = now;
    switch (bytes_.integer(0, 3)) {
      case 0:
        readAnything(message);
        break;
      case 1:
        break;  // lost
      default:
        readGood(message);
    }
  }

 private:
  MapperConfig takeConfig() {
    MapperConfig config;
    element_ = takeElement();
    config.resolution = element_.resolution();
    config.map_size_x = bytes_.integer(1, 12) * config.resolution;
    config.map_size_y = bytes_.integer(1, 40) * config.resolution;
    config.map_size_z = bytes_.integer(1, 70) * config.resolution;
    config.slide_distance = 0.0;
    config.min_ray_length = 0.0;
    config.ray_end_cut = 0.0;
    config.inflation_radius = element_.radius();
    config.inflation_shape = element_.shape;
    return config;
  }

  ElementDefinition takeElement() {
    constexpr int kMostRadiusMm = 1000;
    const auto shape = static_cast<ElementShape>(bytes_.integer(0, 2));
    return {shape, bytes_.integer(0, kMostRadiusMm), kResolutionMm};
  }

  void change() {
    if (bytes_.integer(0, 15) == 0) mapper_.reset();
    if (bytes_.integer(0, 7) == 0) {
      element_ = takeElement();
      MapperConfig config = mapper_.config();
      config.inflation_radius = element_.radius();
      config.inflation_shape = element_.shape;
      mapper_.reconfigure(config);
    }
    const double reach = bytes_.integer(0, 7) == 0 ? 1e6 : bytes_.flag() ? 3.0 : 0.2;
    ScanPose pose;
    pose.vehicle_W = position_ += takeOffset(reach);
    pose.T_W_S.translation() = pose.vehicle_W;
    PointScan scan;
    for (int i = bytes_.integer(0, 12); i > 0; --i) {
      scan.points.push_back(takeOffset(6.0).cast<float>());
    }
    for (int times = bytes_.integer(1, 3); times > 0; --times) mapper_.integrate(scan, pose);
  }

  Eigen::Vector3d takeOffset(double reach) {
    return {bytes_.real(-reach, reach), bytes_.real(-reach, reach), bytes_.real(-reach, reach)};
  }

  void readGood(const MapChanges& message) {
    const auto before = reader_.snapshot();
    const bool is_keyframe = message.previous == 0;
    const bool follows = is_keyframe || (before && before->info().sequence == message.previous);
    if (is_keyframe) is_true_ = true;
    MapChangesReader::Result result;
    try {
      result = reader_.read(message);
    } catch (const std::invalid_argument&) {
      require(!is_true_, "a good message is refused");
      return;
    }
    require((result == MapChangesReader::Result::kMap) == follows, "the order is not kept");
    require((reader_.snapshot() != nullptr) == follows, "a map in spite of a loss");
    if (follows && is_true_) requireSame(*reader_.snapshot(), *sent_);
  }

  static void requireSame(const Snapshot& found, const Snapshot& expected) {
    require(found.window() == expected.window(), "another window");
    for (const Plane plane : {Plane::kOccupied, Plane::kInflated}) {
      require(found.voxels(plane, found.window()) == expected.voxels(plane, expected.window()),
              "other voxels at the far end");
    }
  }

  static test::VoxelSet occupied(const std::shared_ptr<const Snapshot>& map) {
    if (!map) return {};
    const auto voxels = map->voxels(Plane::kOccupied, map->window());
    return test::VoxelSet(voxels.begin(), voxels.end());
  }

  /// A message that is spoiled in a few places: refused, or what its definition says.
  void readAnything(MapChanges message) {
    for (int places = bytes_.integer(1, 3); places > 0; --places) spoil(&message);
    is_true_ = false;
    const bool is_keyframe = message.previous == 0;
    test::ChangesOracle oracle(is_keyframe ? test::VoxelSet() : occupied(reader_.snapshot()));
    try {
      if (reader_.read(message) != MapChangesReader::Result::kMap) {
        require(reader_.snapshot() == nullptr, "a map that is none");
        return;
      }
    } catch (const std::invalid_argument&) {
      require(reader_.snapshot() == nullptr, "a map in spite of an error");
      return;
    }
    const Snapshot& now = *reader_.snapshot();
    require(now.count(Plane::kOccupied) == static_cast<std::int64_t>(message.occupied),
            "another number of voxels");
    oracle.apply(message);
    require(occupied(reader_.snapshot()) == oracle.occupied(),
            "other voxels than the message says");
  }

  void spoil(MapChanges* message) {
    const int axis = bytes_.integer(0, 2);
    switch (bytes_.integer(0, 9)) {
      case 0:
        message->sequence = bytes_.anySize(0, 9);
        break;
      case 1:
        message->previous = bytes_.anySize(0, 9);
        break;
      case 2:
        message->resolution = bytes_.anyDouble(0.01, 10.0);
        break;
      case 3:
        message->window_min[axis] = bytes_.take<std::int32_t>();
        break;
      case 4:
        message->window_max[axis] = message->window_min[axis] + bytes_.integer(0, 255);
        break;
      case 5:
        message->inflation_radius = bytes_.anyDouble(0.0, 3.0);
        message->inflation_shape = bytes_.take<std::uint8_t>();
        break;
      case 6:
        message->occupied = bytes_.anySize(0, 99);
        break;
      case 7:
        message->inflated = bytes_.anySize(0, 999);
        break;
      case 8:
        message->changes = test::zlibStream(bytes_.bytes(bytes_.integer(0, 64)));
        break;
      default:
        if (message->changes.empty()) break;
        message->changes[bytes_.integer(0, 65535) % message->changes.size()] ^=
            bytes_.take<std::uint8_t>();
    }
  }

  ByteSource& bytes_;
  ElementDefinition element_;
  Mapper mapper_;
  MapChangesReader reader_;
  bool is_true_ = false;  // the reader has read nothing spoiled since the last good keyframe
  std::shared_ptr<const Snapshot> sent_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
};

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kMostMessages = 16;
  fiimap::fuzz::ByteSource bytes(data, size);
  fiimap::fuzz::Link link(&bytes);
  for (int i = 0; i < kMostMessages && !bytes.empty(); ++i) link.operate();
  return 0;
}
