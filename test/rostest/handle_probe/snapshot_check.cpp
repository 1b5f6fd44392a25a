#include "snapshot_check.h"

#include <algorithm>
#include <vector>

#include <sensor_msgs/point_cloud2_iterator.h>

namespace fiimap {
namespace {

constexpr std::size_t kSeenSnapshots = 50;

}  // namespace

void SnapshotCheck::expect(bool condition, const std::string& what) {
  if (!condition && failure_.empty()) failure_ = what;
}

void SnapshotCheck::look(const std::shared_ptr<const Snapshot>& snapshot) {
  if (!snapshot || snapshot == newest_) return;
  if (newest_) compareWithNewest(*snapshot);
  checkVoxels(*snapshot);
  newest_ = snapshot;
  ++snapshots_;
  seen_.push_back(snapshot);
  if (seen_.size() > kSeenSnapshots) seen_.pop_front();
}

void SnapshotCheck::compareWithNewest(const Snapshot& snapshot) {
  expect(snapshot.info().sequence > newest_->info().sequence, "the sequence did not increase");
  expect(snapshot.info().stamp_ns > newest_->info().stamp_ns, "the stamp did not increase");
  expect(snapshot.window().size() == newest_->window().size(), "the window changed its size");
}

void SnapshotCheck::checkVoxels(const Snapshot& snapshot) {
  const std::vector<VoxelIndex> occupied = snapshot.voxels(Plane::kOccupied, snapshot.window());
  const std::vector<VoxelIndex> inflated = snapshot.voxels(Plane::kInflated, snapshot.window());
  expect(static_cast<std::int64_t>(occupied.size()) == snapshot.count(Plane::kOccupied) &&
             static_cast<std::int64_t>(inflated.size()) == snapshot.count(Plane::kInflated),
         "the cells do not belong to the counts");
  for (const VoxelIndex& v : occupied) {
    expect(snapshot.window().contains(v), "an occupied voxel is outside of the window");
    expect(snapshot.occupancy(v) == Occupancy::kOccupied, "an occupied voxel is not reported so");
    expect(snapshot.inflation(v) == Inflation::kInflated, "an occupied voxel is not inflated");
  }
  expect(snapshot.occupancy(snapshot.window().max) == Occupancy::kOutside,
         "a voxel beyond the window is not outside");
}

void SnapshotCheck::look(const sensor_msgs::PointCloud2& cloud) {
  const auto stamp = static_cast<std::int64_t>(cloud.header.stamp.toNSec());
  const auto match = std::find_if(seen_.begin(), seen_.end(), [stamp](const auto& snapshot) {
    return snapshot->info().stamp_ns == stamp;
  });
  if (match == seen_.end()) return;
  const Snapshot& snapshot = **match;
  std::int64_t points = 0;
  if (!cloud.data.empty()) {  // the iterator asks for the first byte
    for (sensor_msgs::PointCloud2ConstIterator<float> xyz(cloud, "x"); xyz != xyz.end(); ++xyz) {
      ++points;
      const Eigen::Vector3d point_W(xyz[0], xyz[1], xyz[2]);
      expect(snapshot.occupancy(point_W) == Occupancy::kOccupied,
             "a point of the cloud is not occupied in the snapshot");
    }
  }
  expect(points == snapshot.count(Plane::kOccupied),
         "the cloud has not as many points as the snapshot has occupied voxels");
  ++clouds_;
}

}  // namespace fiimap
