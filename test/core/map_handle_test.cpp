#include "fiimap/map_handle.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "oracle.h"

namespace fiimap {
namespace {

/// A snapshot whose window is at `position` and in which just its lowest and highest voxel are
/// occupied: so anyone can tell whether window and cells belong together.
std::shared_ptr<const Snapshot> marked(SlidingGrid* grid, std::uint64_t sequence,
                                       const VoxelIndex& position) {
  ChangeSet changes;
  grid->clear();
  grid->moveTo(position, &changes);
  grid->set(Plane::kOccupied, grid->window().min, true);
  grid->set(Plane::kOccupied, grid->window().max - VoxelIndex::Ones(), true);
  Snapshot::Info info;
  info.sequence = sequence;
  info.stamp_ns = static_cast<std::int64_t>(sequence) * 10;
  info.resolution = 0.1;
  return std::make_shared<const Snapshot>(grid, info);
}

bool isConsistent(const Snapshot& snapshot) {
  const VoxelBox& window = snapshot.window();
  const std::vector<VoxelIndex> expected = {window.min, window.max - VoxelIndex::Ones()};
  return snapshot.voxels(Plane::kOccupied, window) == expected &&
         snapshot.count(Plane::kOccupied) == 2 &&
         snapshot.occupancy(window.min) == Occupancy::kOccupied &&
         snapshot.info().stamp_ns == static_cast<std::int64_t>(snapshot.info().sequence) * 10;
}

TEST(MapHandleTest, HasNothingBeforeTheFirstScan) {
  const MapHandle handle("/mapping");
  EXPECT_EQ(handle.id(), "/mapping");
  EXPECT_EQ(handle.latest(), nullptr);
}

TEST(MapHandleTest, GivesTheNewestSnapshot) {
  MapHandle handle("/mapping");
  SlidingGrid grid({8, 8, 8});
  for (std::uint64_t sequence = 1; sequence <= 100; ++sequence) {
    const auto snapshot = marked(&grid, sequence, VoxelIndex::Zero());
    handle.publish(snapshot);
    EXPECT_EQ(handle.latest(), snapshot);
    EXPECT_EQ(handle.latest(), snapshot) << "again";
  }
}

TEST(MapHandleTest, HasNothingAfterAReset) {
  MapHandle handle("/mapping");
  SlidingGrid grid({8, 8, 8});
  handle.publish(marked(&grid, 1, VoxelIndex::Zero()));
  handle.publish(nullptr);
  EXPECT_EQ(handle.latest(), nullptr);
  handle.publish(marked(&grid, 2, VoxelIndex::Zero()));
  ASSERT_NE(handle.latest(), nullptr);
  EXPECT_EQ(handle.latest()->info().sequence, 2u);
}

TEST(MapHandleTest, KeepsNoOldSnapshotAlive) {
  MapHandle handle("/mapping");
  SlidingGrid grid({8, 8, 8});
  std::vector<std::weak_ptr<const Snapshot>> published;
  for (std::uint64_t sequence = 1; sequence <= 40; ++sequence) {
    std::shared_ptr<const Snapshot> snapshot = marked(&grid, sequence, VoxelIndex::Zero());
    published.push_back(snapshot);
    handle.publish(std::move(snapshot));
    handle.latest();
  }
  published.pop_back();
  for (const auto& old : published) EXPECT_TRUE(old.expired());
}

TEST(MapHandleTest, ASnapshotOutlivesItsHandle) {
  SlidingGrid grid({8, 8, 8});
  std::shared_ptr<const Snapshot> kept;
  {
    MapHandle handle("/mapping");
    handle.publish(marked(&grid, 3, {5, -6, 7}));
    kept = handle.latest();
  }
  EXPECT_TRUE(isConsistent(*kept));
}

/// What one reader saw.
struct Seen {
  int snapshots = 0;
  int inconsistent = 0;
  int backwards = 0;
};

void readUntil(const std::atomic<bool>& done, const MapHandle& handle, std::atomic<int>* started,
               Seen* seen) {
  std::uint64_t newest = 0;
  std::vector<std::shared_ptr<const Snapshot>> kept;
  started->fetch_add(1);
  while (!done.load() || seen->snapshots == 0) {
    const std::shared_ptr<const Snapshot> snapshot = handle.latest();
    if (snapshot == nullptr) continue;
    ++seen->snapshots;
    if (snapshot->info().sequence < newest) ++seen->backwards;
    if (!isConsistent(*snapshot)) ++seen->inconsistent;
    // Some are held for long.
    constexpr std::uint64_t kKeepEvery = 37;
    if (snapshot->info().sequence != newest && snapshot->info().sequence % kKeepEvery == 0) {
      kept.push_back(snapshot);
    }
    newest = snapshot->info().sequence;
  }
  for (const auto& snapshot : kept) {
    if (!isConsistent(*snapshot)) ++seen->inconsistent;
  }
}

TEST(MapHandleTest, ManyReadersSeeConsistentSnapshotsInOrder) {
  constexpr int kReaders = 20;  // more than the handle has slots
  constexpr std::uint64_t kSnapshots = 3000;
  MapHandle handle("/mapping");
  std::atomic<bool> done{false};
  std::atomic<int> started{0};
  std::vector<Seen> seen(kReaders);
  std::vector<std::thread> readers;
  for (Seen& s : seen) {
    readers.emplace_back([&] { readUntil(done, handle, &started, &s); });
  }
  while (started.load() < kReaders) std::this_thread::yield();

  test::Random random(91);
  SlidingGrid grid({20, 40, 10});
  const VoxelIndex far = VoxelIndex::Constant(50);
  for (std::uint64_t sequence = 1; sequence <= kSnapshots; ++sequence) {
    if (sequence % 100 == 0) handle.publish(nullptr);
    handle.publish(marked(&grid, sequence, test::uniformVoxel(random, {-far, far})));
  }
  done.store(true);
  for (std::thread& reader : readers) reader.join();

  for (const Seen& s : seen) {
    EXPECT_GT(s.snapshots, 0);
    EXPECT_EQ(s.inconsistent, 0);
    EXPECT_EQ(s.backwards, 0);
  }
  EXPECT_EQ(handle.latest()->info().sequence, kSnapshots);
}

TEST(MapRegistryTest, FindsAHandleByItsId) {
  const auto handle = std::make_shared<const MapHandle>("/a/mapping");
  const auto other = std::make_shared<const MapHandle>("/b/mapping");
  MapRegistry::add(handle);
  MapRegistry::add(other);
  EXPECT_EQ(MapRegistry::find("/a/mapping"), handle);
  EXPECT_EQ(MapRegistry::find("/b/mapping"), other);
  EXPECT_EQ(MapRegistry::find("/c/mapping"), nullptr);
  EXPECT_EQ(MapRegistry::find(""), nullptr);
}

TEST(MapRegistryTest, KeepsNoHandleAlive) {
  auto handle = std::make_shared<const MapHandle>("/short/mapping");
  MapRegistry::add(handle);
  const std::weak_ptr<const MapHandle> observer = handle;
  handle.reset();
  EXPECT_TRUE(observer.expired());
  EXPECT_EQ(MapRegistry::find("/short/mapping"), nullptr);
}

TEST(MapRegistryTest, AReloadedMapReplacesItsPredecessor) {
  const auto first = std::make_shared<const MapHandle>("/reloaded/mapping");
  MapRegistry::add(first);
  auto second = std::make_shared<const MapHandle>("/reloaded/mapping");
  MapRegistry::add(second);
  EXPECT_EQ(MapRegistry::find("/reloaded/mapping"), second);
}

TEST(MapRegistryTest, ServesManyThreads) {
  constexpr int kThreads = 8, kRounds = 500;
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([i, &wrong] {
      const std::string id = "/thread" + std::to_string(i);
      for (int round = 0; round < kRounds; ++round) {
        const auto handle = std::make_shared<const MapHandle>(id);
        MapRegistry::add(handle);
        if (MapRegistry::find(id) != handle) ++wrong;
        const auto other = MapRegistry::find("/thread" + std::to_string((i + 1) % kThreads));
        if (other != nullptr && other->id() == id) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong.load(), 0);
}

}  // namespace
}  // namespace fiimap
