#include <octomap/octomap.h>

#include <stdexcept>

#include "complete_file.h"
#include "fiimap/ros/map_files.h"

namespace fiimap {
namespace {

constexpr int kCenterKey = 1 << 15;  // key of the voxel whose lowest corner is the origin

octomap::OcTreeKey keyOf(const VoxelIndex& v) {
  const auto key = [](int index) { return static_cast<octomap::key_type>(index + kCenterKey); };
  return {key(v.x()), key(v.y()), key(v.z())};
}

}  // namespace

// OctoMap's voxels lie on the same lattice as ours: key k covers [k - 2^15, k - 2^15 + 1) edges.
void writeOctomap(const Snapshot& snapshot, const std::string& file) {
  const VoxelBox reach = {VoxelIndex::Constant(-kCenterKey), VoxelIndex::Constant(kCenterKey)};
  if (snapshot.window().intersection(reach) != snapshot.window()) {
    throw std::runtime_error("an OctoMap reaches only " + std::to_string(kCenterKey) +
                             " voxels from the origin");
  }
  octomap::OcTree tree(snapshot.lattice().resolution());
  const bool lazy = true;  // inner nodes once at the end
  for (const VoxelIndex& v : snapshot.voxels(Plane::kKnown, snapshot.window())) {
    tree.setNodeValue(keyOf(v), tree.getClampingThresMinLog(), lazy);
  }
  for (const VoxelIndex& v : snapshot.voxels(Plane::kOccupied, snapshot.window())) {
    tree.setNodeValue(keyOf(v), tree.getClampingThresMaxLog(), lazy);
  }
  tree.updateInnerOccupancy();
  // OctoMap's own file does not tell when the disk is full.
  writeCompleteFile(file, [&tree](std::ostream& stream) { tree.writeBinary(stream); });
}

}  // namespace fiimap
