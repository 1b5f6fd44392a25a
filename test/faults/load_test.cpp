// Three depth cameras and a LiDAR, each with its mapping thread as nodelets of one manager have,
// at their rate and at ten times of it, beside a reader at full speed and one that holds on to old
// snapshots. FIIMAP_LOAD_SECONDS: how long each, for figures; see docs/load.md.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/steady_time.h"
#include "load_messages.h"
#include "mapping_thread.h"

namespace fiimap {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCameras = 3;
constexpr double kCameraRate = 30.0, kLidarRate = 10.0;  // Hz
constexpr double kSpeed = 1.0, kCircle = 3.0;            // m/s, m
constexpr double kMemoryGrowth = 64e6;                   // bytes, noise of the allocator

double secondsPerRun() {
  const char* const seconds = std::getenv("FIIMAP_LOAD_SECONDS");
  return seconds == nullptr ? 2.0 : std::atof(seconds);
}

double residentBytes() {
  std::size_t total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

ros::Time stampOf(Clock::time_point time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(time.time_since_epoch().count()));
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

NodeConfig nodeConfig(SensorKind sensor) {
  NodeConfig config;
  config.sensor = sensor;
  config.extrinsics = ExtrinsicsSource::kParameter;
  if (sensor == SensorKind::kDepth) config.extrinsic_rotation = {-0.5, 0.5, -0.5, 0.5};
  return config;
}

MapperConfig mapperConfig() {
  MapperConfig config;
  config.map_size_x = config.map_size_y = 30.0;
  return config;
}

/// A sensor at a rate, its map, and how old scans are when they can be read.
class LoadedMap : private MapObserver {
 public:
  LoadedMap(SensorKind sensor, double rate)
      : sensor_(sensor),
        period_(
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate))),
        handle_(std::make_shared<MapHandle>("load")),
        mapping_(mapperConfig(), nodeConfig(sensor), handle_, this) {
    mapping_.start();
    mapping_.post([](ScanSynchronizer* synchronizer) {
      const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
      info->width = kLoadWidth;
      info->height = kLoadHeight;
      info->K = {400.0, 0.0, kLoadWidth / 2.0, 0.0, 400.0, kLoadHeight / 2.0, 0.0, 0.0, 1.0};
      synchronizer->add(sensor_msgs::CameraInfoConstPtr(info));
    });
  }
  ~LoadedMap() override { mapping_.stop(); }

  /// Feeds the map until `end`.
  void feed(Clock::time_point end) {
    for (auto next = Clock::now(); next < end; next += period_) {
      std::this_thread::sleep_until(next);
      const ScanCounters counters = mapping_.counters();
      most_waiting_ = std::max(most_waiting_, counters.waiting);
      const auto now = Clock::now();
      addPose(now - std::chrono::milliseconds(10));
      addPose(now);
      addScan(stampOf(now - std::chrono::milliseconds(5)));
      ++sent_;
    }
    while (mapping_.counters().received < sent_ || mapping_.counters().waiting > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  const MapHandle& handle() const { return *handle_; }

  void expectConserved() const {
    const ScanCounters counters = mapping_.counters();
    EXPECT_EQ(counters.received, sent_);
    EXPECT_TRUE(counters.conserved());
    EXPECT_GT(counters.integrated, 0u);
    EXPECT_EQ(counters.dropped(), counters.dropped(DropReason::kOverload)) << counters.last_drop;
    const NodeConfig config;
    EXPECT_LE(most_waiting_,
              static_cast<std::uint64_t>(config.scan_queue_size + config.ready_queue_size));
  }
  void print() const {
    const ScanCounters counters = mapping_.counters();
    std::printf("  %-6s sent %5lu integrated %5lu dropped %5lu, age ms: median %.1f max %.1f\n",
                sensor_ == SensorKind::kDepth ? "camera" : "LiDAR", sent_, counters.integrated,
                counters.dropped(), percentile(ages_ms_, 0.5), percentile(ages_ms_, 1.0));
  }

 private:
  void addPose(Clock::time_point time) {
    nav_msgs::Odometry pose;
    pose.header.stamp = stampOf(time);
    pose.header.frame_id = "world";
    const double seconds = std::chrono::duration<double>(time.time_since_epoch()).count();
    const double angle = kSpeed / kCircle * seconds;
    pose.pose.pose.position.x = kCircle * std::cos(angle);
    pose.pose.pose.position.y = kCircle * std::sin(angle);
    pose.pose.pose.orientation.z = std::sin(angle / 2.0);
    pose.pose.pose.orientation.w = std::cos(angle / 2.0);
    mapping_.post([pose](ScanSynchronizer* synchronizer) { synchronizer->add(pose); });
  }
  void addScan(const ros::Time& stamp) {
    if (sensor_ == SensorKind::kDepth) {
      const ImagePtr image = unused(&images_, makeImage);
      image->header.stamp = stamp;
      mapping_.addScan(sensor_msgs::ImageConstPtr(image));
    } else {
      const CloudPtr cloud = unused(&clouds_, makeCloud);
      cloud->header.stamp = stamp;
      mapping_.addScan(sensor_msgs::PointCloud2ConstPtr(cloud));
    }
  }
  /// A message that nobody holds any more: making one costs more than mapping it.
  template <typename Pointer>
  static Pointer unused(std::vector<Pointer>* pool, Pointer (*make)()) {
    for (const Pointer& message : *pool) {
      if (message.use_count() == 1) return message;
    }
    pool->push_back(make());
    return pool->back();
  }

  void onUpdate(const MapUpdate& update) override {
    const auto now = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
    ages_ms_.push_back(static_cast<double>(now - update.pose.stamp_ns) * 1e-6);
  }
  void onReset(const std::string& why) override { ADD_FAILURE() << why; }
  void onDrop(const Drop&) override {}
  void onWarning(const std::string&) override {}

  SensorKind sensor_;
  Clock::duration period_;
  std::uint64_t sent_ = 0, most_waiting_ = 0;
  std::vector<ImagePtr> images_;
  std::vector<CloudPtr> clouds_;
  std::vector<double> ages_ms_;
  std::shared_ptr<MapHandle> handle_;
  MappingThread mapping_;
};

/// Asks all maps, as fast as it can, until it is told to stop.
class FastReader {
 public:
  void run(const std::vector<std::unique_ptr<LoadedMap>>& maps, const std::atomic<bool>& ended) {
    while (!ended) {
      for (const auto& map : maps) {
        const auto start = Clock::now();
        const std::shared_ptr<const Snapshot> snapshot = map->handle().latest();
        if (snapshot != nullptr) snapshot->inflation(Eigen::Vector3d(1.0, 2.0, 0.5));
        count(millisecondsSince(start));
      }
    }
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    waits_ = usage.ru_nvcsw;
  }
  void print() const {
    std::printf("  reader %ld queries, longest %.3f ms;", queries_, longest_ms_);
    for (std::size_t i = 0; i < kLimitsMs.size(); ++i) {
      std::printf(" %ld above %g ms,", above_[i], kLimitsMs[i]);
    }
    std::printf(" the thread slept %ld times\n", waits_);
  }

 private:
  static constexpr std::array<double, 4> kLimitsMs = {0.01, 0.1, 1.0, 10.0};

  void count(double ms) {
    ++queries_;
    longest_ms_ = std::max(longest_ms_, ms);
    for (std::size_t i = 0; i < kLimitsMs.size(); ++i) above_[i] += ms > kLimitsMs[i];
  }

  long queries_ = 0;
  double longest_ms_ = 0.0;
  std::array<long, kLimitsMs.size()> above_{};
  long waits_ = 0;  // times that the thread gave the processor away by itself
};

void holdOldSnapshots(const LoadedMap& map, const std::atomic<bool>& ended) {
  while (!ended) {
    const std::shared_ptr<const Snapshot> held = map.handle().latest();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

class LoadTest : public testing::TestWithParam<int> {};

TEST_P(LoadTest, EveryScanIsAccountedForAndMemoryIsFlat) {
  ros::Time::init();
  std::vector<std::unique_ptr<LoadedMap>> maps;
  for (int i = 0; i < kCameras; ++i) {
    maps.push_back(std::make_unique<LoadedMap>(SensorKind::kDepth, GetParam() * kCameraRate));
  }
  maps.push_back(std::make_unique<LoadedMap>(SensorKind::kPoints, GetParam() * kLidarRate));

  std::atomic<bool> ended{false};
  FastReader reader;
  const auto feedAll = [&maps](double seconds) {
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(seconds));
    std::vector<std::thread> feeders;
    for (const auto& map : maps) feeders.emplace_back([&map, end] { map->feed(end); });
    for (std::thread& feeder : feeders) feeder.join();
  };
  std::thread holder([&] { holdOldSnapshots(*maps[0], ended); });
  std::thread reading([&] { reader.run(maps, ended); });
  feedAll(secondsPerRun() / 2.0);
  const double memory_halfway = residentBytes();
  feedAll(secondsPerRun() / 2.0);
  const double growth = residentBytes() - memory_halfway;
  ended = true;
  holder.join();
  reading.join();

  std::printf("%d x the rate, memory %.0f MB, second half %+.1f MB\n", GetParam(),
              memory_halfway * 1e-6, growth * 1e-6);
  for (const auto& map : maps) {
    map->expectConserved();
    map->print();
  }
  reader.print();
  EXPECT_LT(growth, kMemoryGrowth);
}

INSTANTIATE_TEST_SUITE_P(Rates, LoadTest, testing::Values(1, 10));

}  // namespace
}  // namespace fiimap
