#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/map_handle.h"
#include "fiimap/mapper.h"
#include "mapper_fixture.h"
#include "oracle.h"

/// A map in one thread with many readers in others, through resets, changes of radius and unloads:
/// for the thread sanitizer as much as for what is asserted.
namespace fiimap {
namespace {

constexpr char kId[] = "/threads/mapping";

/// Whether cells, counts and inflation of a snapshot belong together.
bool isWhole(const Snapshot& snapshot) {
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    const auto voxels = snapshot.voxels(plane, snapshot.window());
    if (static_cast<std::int64_t>(voxels.size()) != snapshot.count(plane)) return false;
  }
  for (const VoxelIndex& v : snapshot.voxels(Plane::kOccupied, snapshot.window())) {
    if (snapshot.occupancy(v) != Occupancy::kOccupied) return false;
    if (snapshot.inflation(v) != Inflation::kInflated) return false;
  }
  return true;
}

/// Reads whatever map is there until told to stop, and once more.
void read(const std::atomic<bool>& done, std::atomic<int>* wrong, std::atomic<int>* read_maps) {
  std::shared_ptr<const Snapshot> held;  // outlives its map now and then
  do {
    const std::shared_ptr<const MapHandle> handle = MapRegistry::find(kId);
    if (handle == nullptr) continue;
    const std::shared_ptr<const Snapshot> snapshot = handle->latest();
    if (snapshot == nullptr) continue;
    if (!isWhole(*snapshot)) ++*wrong;
    if (held == nullptr || snapshot->info().sequence % 16 == 0) held = snapshot;
    if (!isWhole(*held)) ++*wrong;
    ++*read_maps;
    std::this_thread::yield();
  } while (!done.load());
}

/// One life of a mapping nodelet.
void fly(test::Random* random, int scans) {
  Mapper mapper(test::smallConfig());
  const auto handle = std::make_shared<MapHandle>(kId);
  MapRegistry::add(handle);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int scan = 0; scan < scans; ++scan) {
    for (int axis = 0; axis < 3; ++axis) position[axis] += test::uniformReal(*random, -1.0, 1.0);
    PointScan points;
    for (int i = 0; i < 40; ++i) {
      points.points.emplace_back(2.0f, static_cast<float>(test::uniformReal(*random, -2.0, 2.0)),
                                 static_cast<float>(test::uniformReal(*random, -1.0, 1.0)));
    }
    const ScanPose pose = test::poseAt(position, scan + 1);
    mapper.integrate(points, pose);
    mapper.integrate(points, pose);
    handle->publish(mapper.snapshot());
    if (test::chance(*random, 0.05)) {
      mapper.reset();
      handle->publish(nullptr);
    }
    if (test::chance(*random, 0.05)) {
      MapperConfig config = mapper.config();
      config.inflation_radius = test::uniformReal(*random, 0.0, 1.0);
      config.p_occ = test::uniformReal(*random, 0.6, 0.9);
      mapper.reconfigure(config);
    }
  }
}

TEST(MapThreadsTest, ReadersSeeWholeMapsThroughResetsChangesAndUnloads) {
  constexpr int kReaders = 8;
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0}, read_maps{0};
  std::vector<std::thread> readers;
  for (int i = 0; i < kReaders; ++i) {
    readers.emplace_back([&] { read(done, &wrong, &read_maps); });
  }
  test::Random random(23);
  for (int life = 0; life < 4 || read_maps.load() < kReaders; ++life) {
    fly(&random, test::effort(60));
  }
  done.store(true);
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong.load(), 0);
  EXPECT_EQ(MapRegistry::find(kId), nullptr) << "nobody keeps an unloaded map";
}

}  // namespace
}  // namespace fiimap
