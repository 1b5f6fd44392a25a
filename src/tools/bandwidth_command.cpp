#include "bandwidth_command.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <ros/serialization.h>

#include "fiimap/mapper.h"
#include "fiimap/ros/map_changes.h"
#include "fiimap/ros/map_changes_reader.h"
#include "fiimap/ros/map_messages.h"
#include "fiimap/ros/scan_decoder.h"
#include "quantiles.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

constexpr double kSecondsPerNanosecond = 1e-9;
constexpr double kKilobyte = 1000.0;

/// Bytes of the messages of one kind, as they go through a TCP connection of ROS.
class Traffic {
 public:
  template <typename Message>
  void add(const Message& message) {
    constexpr std::uint32_t kLengthPrefix = 4;
    sizes_.push_back(ros::serialization::serializationLength(message) + kLengthPrefix);
    total_ += sizes_.back();
  }

  nlohmann::json json(double seconds) const {
    const Quantiles sizes = quantilesOf(sizes_);
    return {{"messages", sizes_.size()},
            {"bytes", total_},
            {"bytes_per_second", total_ / seconds},
            {"median_bytes", sizes.median},
            {"max_bytes", sizes.max}};
  }

  std::string row(const char* name, double seconds) const {
    const Quantiles sizes = quantilesOf(sizes_);
    char line[160];
    std::snprintf(line, sizeof(line), "%-22s %8zu %11.3f %11.3f %11.3f\n", name, sizes_.size(),
                  sizes.median / kKilobyte, sizes.max / kKilobyte, total_ / seconds / kKilobyte);
    return line;
  }

 private:
  std::vector<double> sizes_;
  double total_ = 0.0;
};

/// Publishes as the node does, by the stamps of the scans instead of a clock.
class LinkMeter : public ScanEvaluator {
 public:
  LinkMeter(const MapperConfig& mapper, const NodeConfig& node)
      : mapper_(mapper), node_(node), reader_(mapper.memory_limit) {}

  void finish() { publishPending(); }

  /// Of the recording, without the time over which stamps jumped.
  double seconds() const { return seconds_ + newest_ - first_; }
  std::size_t wrong() const { return wrong_; }

  nlohmann::json json() const {
    nlohmann::json json = toJson(counters());
    json["seconds"] = seconds();
    json["occupied"] = occupied_.json(seconds());
    json["inflated"] = inflated_.json(seconds());
    json["changes"] = changes_.json(seconds());
    json["keyframes"] = keyframes_.json(seconds());
    json["wrong"] = wrong_;
    return json;
  }

  std::string text() const {
    return "messages                 number   median kB      max kB        kB/s\n" +
           occupied_.row("~occupied", seconds()) + inflated_.row("~inflated", seconds()) +
           changes_.row("~changes", seconds()) + keyframes_.row("  of these keyframes", seconds());
  }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    decoder_.integrate(scan, &mapper_);
    std::shared_ptr<const Snapshot> snapshot = mapper_.snapshot();
    const double stamp = static_cast<double>(snapshot->info().stamp_ns) * kSecondsPerNanosecond;
    if (pending_ && stamp > due_) publishPending();
    if (!has_begun_) first_ = due_ = keyframe_due_ = stamp;
    has_begun_ = true;
    newest_ = stamp;
    due_ = std::max(due_, stamp);
    pending_ = std::move(snapshot);
  }

  void forget() override {
    publishPending();
    seconds_ += newest_ - first_;
    first_ = newest_;
    has_begun_ = false;
    published_ = nullptr;
    mapper_.reset();
  }

  /// At due_, of the newest scan until then.
  void publishPending() {
    if (!pending_) return;
    const bool is_keyframe = !published_ || due_ >= keyframe_due_;
    const MapChanges message =
        toMapChanges(*pending_, is_keyframe ? nullptr : published_.get(), node_.map_frame);
    const auto occupied = toPointCloud(*pending_, Plane::kOccupied, node_.map_frame);
    const auto inflated = toPointCloud(*pending_, Plane::kInflated, node_.map_frame);
    occupied_.add(occupied);
    inflated_.add(inflated);
    changes_.add(message);
    if (is_keyframe) {
      keyframes_.add(message);
      keyframe_due_ = due_ + node_.keyframe_period;
    }
    reader_.read(message);
    const std::shared_ptr<const Snapshot> read = reader_.snapshot();
    const bool is_same =
        read && toPointCloud(*read, Plane::kOccupied, node_.map_frame).data == occupied.data &&
        toPointCloud(*read, Plane::kInflated, node_.map_frame).data == inflated.data;
    if (!is_same) ++wrong_;
    published_ = std::move(pending_);
    pending_ = nullptr;
    due_ += 1.0 / node_.publish_rate;
  }

  Mapper mapper_;
  ScanDecoder decoder_;
  NodeConfig node_;
  MapChangesReader reader_;

  bool has_begun_ = false;             // since time jumped last
  double first_ = 0.0, newest_ = 0.0;  // stamps since then, s
  double seconds_ = 0.0;               // before then
  double due_ = 0.0, keyframe_due_ = 0.0;
  std::shared_ptr<const Snapshot> pending_, published_;

  Traffic occupied_, inflated_, changes_, keyframes_;
  std::size_t wrong_ = 0;
};

}  // namespace

int measureBandwidth(const BandwidthOptions& options) {
  const EvaluationInput input(options.input);
  LinkMeter meter(input.mapper(), input.node());
  meter.play(input);
  meter.finish();
  meter.printWarnings();
  std::cout << options.input.bag << ", " << meter.seconds() << " s\n" << meter.text();
  nlohmann::json json = meter.json();
  json["warnings"] = meter.warnings();
  input.writeJson(json);
  std::cout << meter.wrong() << " maps were others at the far end\n";
  return meter.wrong() == 0 ? 0 : 1;
}

}  // namespace fiimap
