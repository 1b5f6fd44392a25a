#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include <sensor_msgs/PointCloud2.h>

#include "fiimap/snapshot.h"

namespace fiimap {

/// What a reader saw of one map. Not thread-safe.
class SnapshotCheck {
 public:
  /// Looks at the newest snapshot of a handle; may see the same one often.
  void look(const std::shared_ptr<const Snapshot>& snapshot);
  /// Compares a cloud of occupied voxels with the snapshot of its stamp, when that was seen.
  void look(const sensor_msgs::PointCloud2& cloud);
  /// Another handle counts its sequence anew.
  void onNewHandle() { newest_.reset(); }

  /// What was wrong first; empty when all is well.
  const std::string& failure() const { return failure_; }
  std::uint64_t snapshots() const { return snapshots_; }
  std::uint64_t clouds() const { return clouds_; }
  std::uint64_t sequence() const { return newest_ ? newest_->info().sequence : 0; }

 private:
  void expect(bool condition, const std::string& what);
  void compareWithNewest(const Snapshot& snapshot);
  void checkVoxels(const Snapshot& snapshot);

  std::shared_ptr<const Snapshot> newest_;
  std::deque<std::shared_ptr<const Snapshot>> seen_;
  std::uint64_t snapshots_ = 0;  // different ones
  std::uint64_t clouds_ = 0;     // compared ones
  std::string failure_;
};

}  // namespace fiimap
