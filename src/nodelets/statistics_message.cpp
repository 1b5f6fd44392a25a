#include "statistics_message.h"

#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

void setTimes(const StageTimes& times, double decode_ms, Statistics* message) {
  message->project_ms = times.project;
  message->slide_ms = times.slide;
  message->raycast_ms = times.raycast;
  message->fuse_ms = times.fuse;
  message->inflate_ms = times.inflate;
  message->snapshot_ms = times.snapshot;
  message->total_ms = times.total();
  message->convert_ms = decode_ms;
}

void setScan(const ScanReport& report, Statistics* message) {
  message->readings = report.readings.total;
  message->returns = report.readings.returns;
  message->ignored = report.readings.ignored;
  message->invalid = report.readings.invalid;
  message->too_near = report.readings.too_near;
  message->infinite = report.readings.infinite;
  message->too_far = report.readings.too_far;
  message->ray_hits = report.rays.hits;
  message->ray_misses = report.rays.misses;
  message->raise = report.raise;
  message->lower = report.lower;
  message->change_score = report.changeScore();
  message->forgotten = report.forgotten;
}

void setCounters(const ScanCounters& counters, Statistics* message) {
  message->received = counters.received;
  message->integrated = counters.integrated;
  message->dropped = counters.dropped();
  message->waiting = counters.waiting;
  for (int i = 0; i < kDropReasonCount; ++i) {
    const auto reason = static_cast<DropReason>(i);
    if (counters.dropped(reason) == 0) continue;
    DropCount drop;
    drop.reason = nameOf(reason);
    drop.count = counters.dropped(reason);
    message->drops.push_back(drop);
  }
}

}  // namespace

Statistics toStatistics(const MapUpdate& update, const std::string& map_frame) {
  Statistics message;
  message.header = toHeader(update.pose.stamp_ns, map_frame);
  message.sequence = update.snapshot->info().sequence;
  message.sensor = update.sensor;
  setTimes(update.report.times_ms, update.decode_ms, &message);
  setScan(update.report, &message);
  message.occupied = static_cast<std::uint64_t>(update.snapshot->count(Plane::kOccupied));
  message.inflated = static_cast<std::uint64_t>(update.snapshot->count(Plane::kInflated));
  message.memory_bytes = update.memory_bytes;
  message.pose_gap = update.pose_gap;
  setCounters(update.counters, &message);
  return message;
}

}  // namespace fiimap
