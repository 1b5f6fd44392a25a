// Three depth cameras and a LiDAR into one map, at their rate and at ten times of it, beside a
// reader at full speed and one that holds on to old snapshots. FIIMAP_LOAD_SECONDS: how long each,
// see docs/load.md.

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
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "fiimap/ros/steady_time.h"
#include "load_messages.h"
#include "mapping_thread.h"

namespace fiimap {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kCameras = 3, kLidar = kCameras;   // number of the LiDAR: after the cameras
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

NodeConfig nodeConfig() {
  NodeConfig config;
  config.extrinsics = ExtrinsicsSource::kParameter;
  // Poses come with the scans: on a busy machine there may be none for a while.
  config.max_pose_gap = config.max_pose_wait = config.pose_history = 60.0;
  config.sensors.assign(kLidar + 1, config);
  // Ahead, to the left and to the right, as optical frames.
  const std::array<Eigen::Vector4d, kCameras> rotations = {{{-0.5, 0.5, -0.5, 0.5},
                                                            {-M_SQRT1_2, 0.0, 0.0, M_SQRT1_2},
                                                            {0.0, M_SQRT1_2, -M_SQRT1_2, 0.0}}};
  for (std::size_t i = 0; i < kCameras; ++i) {
    config.sensors[i].name = "camera_" + std::to_string(i);
    config.sensors[i].extrinsic_rotation = rotations[i];
  }
  config.sensors[kLidar].name = "lidar";
  config.sensors[kLidar].sensor = SensorKind::kPoints;
  return config;
}

MapperConfig mapperConfig() {
  MapperConfig config;
  config.map_size_x = config.map_size_y = 30.0;
  config.sensors.assign(kLidar + 1, config);
  return config;
}

/// What a sensor sent, and how old its scans were when they could be read.
struct Sensor {
  std::uint64_t sent = 0, most_waiting = 0;
  std::vector<ImagePtr> images;
  std::vector<CloudPtr> clouds;
  std::vector<double> ages_ms;
};

/// The map of all sensors.
class LoadedMap : private MapObserver {
 public:
  LoadedMap()
      : handle_(std::make_shared<MapHandle>("load")),
        mapping_(mapperConfig(), nodeConfig(), handle_, this) {
    mapping_.start();
    const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    info->width = kLoadWidth;
    info->height = kLoadHeight;
    info->K = {400.0, 0.0, kLoadWidth / 2.0, 0.0, 400.0, kLoadHeight / 2.0, 0.0, 0.0, 1.0};
    for (std::size_t camera = 0; camera < kCameras; ++camera) {
      mapping_.post([info, camera](ScanSynchronizer* synchronizer) {
        synchronizer->add(sensor_msgs::CameraInfoConstPtr(info), camera);
      });
    }
    addPose(Clock::now() - std::chrono::seconds(1));
  }
  ~LoadedMap() override { mapping_.stop(); }

  /// Feeds the map with one sensor until `end`. \param rate Hz.
  void feed(std::size_t number, double rate, Clock::time_point end) {
    Sensor& sensor = sensors_[number];
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate));
    for (auto next = Clock::now(); next < end; next += period) {
      std::this_thread::sleep_until(next);
      sensor.most_waiting = std::max(sensor.most_waiting, countersOf(number).waiting);
      // Together, so that the stamps of poses only grow.
      const std::lock_guard<std::mutex> lock(feed_mutex_);
      const auto now = Clock::now();
      addPose(now);
      addScan(number, stampOf(now - std::chrono::milliseconds(5)));
      ++sensor.sent;
    }
    while (countersOf(number).received < sensor.sent || countersOf(number).waiting > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  const MapHandle& handle() const { return *handle_; }
  ScanCounters countersOf(std::size_t sensor) const {
    return mapping_.counters().sensors.at(sensor);
  }

  void expectConserved() const {
    const ScanCounters all = mapping_.counters();
    EXPECT_TRUE(all.conserved());
    EXPECT_EQ(all.dropped(), all.dropped(DropReason::kOverload)) << all.last_drop;
    const NodeConfig config;
    for (std::size_t i = 0; i <= kLidar; ++i) {
      EXPECT_EQ(countersOf(i).received, sensors_[i].sent);
      EXPECT_GT(countersOf(i).integrated, 0u);
      EXPECT_LE(sensors_[i].most_waiting,
                static_cast<std::uint64_t>(config.scan_queue_size + config.ready_queue_size));
    }
  }
  /// The LiDAR sends less than each camera: it gets as many turns, or all that it needs.
  void expectFair() const {
    std::uint64_t fewest = sensors_[kLidar].sent;
    for (std::size_t i = 0; i < kLidar; ++i) fewest = std::min(fewest, countersOf(i).integrated);
    EXPECT_GE(2 * countersOf(kLidar).integrated, fewest);
  }
  void print() const {
    for (std::size_t i = 0; i <= kLidar; ++i) {
      const ScanCounters counters = countersOf(i);
      std::printf("  %-8s sent %5lu integrated %5lu dropped %5lu, age ms: median %.1f max %.1f\n",
                  nodeConfig().sensors[i].name.c_str(), sensors_[i].sent, counters.integrated,
                  counters.dropped(), percentile(sensors_[i].ages_ms, 0.5),
                  percentile(sensors_[i].ages_ms, 1.0));
    }
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
  void addScan(std::size_t sensor, const ros::Time& stamp) {
    if (sensor != kLidar) {
      const ImagePtr image = unused(&sensors_[sensor].images, makeImage);
      image->header.stamp = stamp;
      mapping_.addScan(sensor_msgs::ImageConstPtr(image), sensor);
    } else {
      const CloudPtr cloud = unused(&sensors_[sensor].clouds, makeCloud);
      cloud->header.stamp = stamp;
      mapping_.addScan(sensor_msgs::PointCloud2ConstPtr(cloud), sensor);
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
    const std::string after_line = update.sensor.substr(update.sensor.find('_') + 1);
    const std::size_t number = update.sensor == "lidar" ? kLidar : std::stoul(after_line);
    sensors_[number].ages_ms.push_back(static_cast<double>(now - update.pose.stamp_ns) * 1e-6);
  }
  void onReset(const std::string& why) override { ADD_FAILURE() << why; }
  void onDrop(const Drop&) override {}
  void onWarning(const std::string&) override {}

  std::mutex feed_mutex_;
  std::array<Sensor, kLidar + 1> sensors_;
  std::shared_ptr<MapHandle> handle_;
  MappingThread mapping_;
};

/// Asks the map, as fast as it can, until it is told to stop.
class FastReader {
 public:
  void run(const LoadedMap& map, const std::atomic<bool>& ended) {
    while (!ended) {
      const auto start = Clock::now();
      const std::shared_ptr<const Snapshot> snapshot = map.handle().latest();
      if (snapshot != nullptr) snapshot->inflation(Eigen::Vector3d(1.0, 2.0, 0.5));
      count(millisecondsSince(start));
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
  LoadedMap map;
  std::atomic<bool> ended{false};
  FastReader reader;
  const auto feedAll = [&map](double seconds) {
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(seconds));
    std::vector<std::thread> feeders;
    for (std::size_t sensor = 0; sensor <= kLidar; ++sensor) {
      const double rate = GetParam() * (sensor == kLidar ? kLidarRate : kCameraRate);
      feeders.emplace_back([&map, sensor, rate, end] { map.feed(sensor, rate, end); });
    }
    for (std::thread& feeder : feeders) feeder.join();
  };
  std::thread holder([&] { holdOldSnapshots(map, ended); });
  std::thread reading([&] { reader.run(map, ended); });
  feedAll(secondsPerRun() / 2.0);
  const double memory_halfway = residentBytes();
  feedAll(secondsPerRun() / 2.0);
  const double growth = residentBytes() - memory_halfway;
  ended = true;
  holder.join();
  reading.join();

  std::printf("%d x the rate, memory %.0f MB, second half %+.1f MB\n", GetParam(),
              memory_halfway * 1e-6, growth * 1e-6);
  map.expectConserved();
  map.expectFair();
  map.print();
  reader.print();
  EXPECT_LT(growth, kMemoryGrowth);
}

INSTANTIATE_TEST_SUITE_P(Rates, LoadTest, testing::Values(1, 10));

}  // namespace
}  // namespace fiimap
