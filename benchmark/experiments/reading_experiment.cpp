#include <random>

#include "experiments.h"
#include "mapping_method.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

constexpr int kQueries = 10000;
constexpr double kNear = 3.0;  // m around the vehicle

std::vector<Eigen::Vector3d> offsetsNearVehicle() {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> offset(-kNear, kNear);
  std::vector<Eigen::Vector3d> offsets;
  for (int i = 0; i < kQueries; ++i) {
    offsets.emplace_back(offset(random), offset(random), offset(random));
  }
  return offsets;
}

}  // namespace

void measureReading(const Recording& recording, Samples* samples) {
  const std::vector<Eigen::Vector3d> offsets = offsetsNearVehicle();
  for (const double resolution : {0.2, 0.1, 0.05}) {
    const nlohmann::json setting = {{"resolution", resolution}};
    Series snapshots{"snapshot", recording.name, kFiimap, setting, {}};
    Series queries{"query", recording.name, kFiimap, setting, {}};
    Series memory{"memory_bytes", recording.name, kFiimap, setting, {}};
    Mapper mapper(configAt(resolution, kReach));
    std::size_t inflated = 0;
    for (const Frame& frame : recording.frames) {
      mapper.integrate(frame.image.view, frame.intrinsics, frame.pose);
      std::shared_ptr<const Snapshot> snapshot;
      snapshots.values.push_back(microsecondsOf([&] { snapshot = mapper.snapshot(); }));
      const double all_queries = microsecondsOf([&] {
        for (const Eigen::Vector3d& offset : offsets) {
          const Eigen::Vector3d point_W = frame.pose.vehicle_W + offset;
          if (snapshot->inflation(point_W) == Inflation::kInflated) ++inflated;
        }
      });
      queries.values.push_back(all_queries / kQueries);
    }
    memory.values.push_back(static_cast<double>(mapper.memoryBytes()));
    memory.values.push_back(static_cast<double>(mapper.grid().worstCaseMemoryBytes()));
    Series found{"queries_inflated", recording.name, kFiimap, setting, {}};
    found.values.push_back(
        static_cast<double>(inflated));  // keeps the queries from being optimised out
    for (const Series& one : {snapshots, queries, memory, found}) samples->add(one);
  }
}

}  // namespace fiimap::bench
