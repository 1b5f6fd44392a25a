#pragma once

#include <string>

#include "byte_source.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/scan_counters.h"
#include "fiimap/ros/scan_decoder.h"
#include "fiimap/ros/scan_synchronizer.h"
#include "inflation_check.h"

namespace fiimap::fuzz {

/// A map small enough for thousands of inputs a second.
inline MapperConfig smallMap() {
  MapperConfig config;
  config.resolution = 0.25;
  config.map_size_x = config.map_size_y = 8.0;
  config.map_size_z = 4.0;
  config.pixel_step = 1;
  config.border_margin = 0;
  return config;
}

/// Sensor at the body, whose poses are transforms from "world".
inline NodeConfig nodeWithoutTf(SensorKind sensor) {
  NodeConfig config;
  config.sensor = sensor;
  config.pose_source = PoseSource::kTransform;
  config.extrinsics = ExtrinsicsSource::kParameter;
  return config;
}

/// From messages to a map, as the nodelet and fiimap_eval do it; each scan must be integrated or
/// dropped for a reason, whatever it holds, and the map must be exact afterwards.
class ScanFeed : public ScanListener {
 public:
  ScanFeed(const MapperConfig& mapper, const NodeConfig& node)
      : mapper_(mapper), synchronizer_(node, this) {}

  ScanSynchronizer& synchronizer() { return synchronizer_; }
  ScanCounters& counters() { return counters_; }
  void add(const ScanMessage& scan, std::size_t sensor = 0) {
    ++counters_.received;
    synchronizer_.add(scan, Moment(), sensor);
  }

  void finish() {
    synchronizer_.finish();
    checkCounters();
    require(countInflationMismatches(*mapper_.snapshot()) == 0, "the inflated layer is not exact");
  }
  /// Without anything that waits.
  void checkCounters() const {
    require(counters_.received == counters_.integrated + counters_.dropped(),
            "a scan is neither integrated nor dropped");
  }

  void onScan(const SynchronizedScan& scan) override {
    try {
      const ScanReport report = decoder_.integrate(scan, &mapper_);
      const ReadingCount& count = report.readings;
      require(count.total ==
                  count.returns + count.invalid + count.too_near + count.infinite + count.too_far,
              "a reading is of no kind");
      ++counters_.integrated;
    } catch (const InputError& error) {
      onDrop(error.drop(), scan.sensor);
    }
  }
  void onDrop(const Drop& drop, std::size_t) override {
    require(!drop.text().empty(), "a scan is dropped without a reason");
    counters_.countDrop(drop);
  }
  void onTimeJump(const std::string&) override { mapper_.reset(); }
  void onWarning(const std::string& text) override { require(!text.empty(), "an empty warning"); }

 private:
  Mapper mapper_;
  ScanDecoder decoder_;
  ScanCounters counters_;
  ScanSynchronizer synchronizer_;
};

/// Pose of the vehicle at a stamp, at the origin.
inline geometry_msgs::TransformStamped poseAt(const ros::Time& stamp) {
  geometry_msgs::TransformStamped pose;
  pose.header.frame_id = "world";
  pose.header.stamp = stamp;
  pose.transform.rotation.w = 1.0;
  return pose;
}

}  // namespace fiimap::fuzz
