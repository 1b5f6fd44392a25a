#include <octomap/octomap.h>

#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "complete_file.h"
#include "fiimap/ros/map_files.h"
#include "saved_map_file.h"

namespace fiimap {
namespace {

constexpr int kCenterKey = 1 << 15;  // key of the voxel whose lowest corner is the origin
const char* const kFirstLine = "# Octomap OcTree binary file";

octomap::OcTreeKey keyOf(const VoxelIndex& v) {
  const auto key = [](int index) { return static_cast<octomap::key_type>(index + kCenterKey); };
  return {key(v.x()), key(v.y()), key(v.z())};
}

/// What a .bt file says of itself before its nodes.
struct Header {
  std::string id;
  double resolution = 0.0;
  long nodes = -1;
};

Header readOctomapHeader(SavedMapFile* file) {
  Header header;
  if (file->line().rfind(kFirstLine, 0) != 0) file->fail("is not an OctoMap .bt file");
  for (std::string line = file->line(); line != "data"; line = file->line()) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "id") words >> header.id;
    if (key == "res") words >> header.resolution;
    if (key == "size") words >> header.nodes;
  }
  if (header.id != "OcTree") file->fail("holds a tree of the kind '" + header.id + "', not OcTree");
  if (!(header.resolution > 0.0)) file->fail("has no resolution");
  return header;
}

/// Reads the nodes of a .bt file into boxes of voxels: of each inner node two bytes with two bits
/// for each of its children, then the children that are inner nodes, depth first. OctoMap's own
/// reader goes as deep as a damaged file leads it, until the stack ends.
class NodeReader {
 public:
  NodeReader(SavedMapFile* file, SavedMap* map) : file_(*file), map_(*map) {}

  /// \param node that is an inner one.
  void read(const VoxelBox& node) {
    const int half = node.size().x() / 2;
    if (half == 0) file_.fail("is damaged: it has nodes smaller than a voxel");
    const std::uint16_t bits = file_.take<std::uint16_t>();
    if (bits == 0) file_.fail("is damaged: it has an inner node without children");
    const auto boxOf = [&](int child) -> VoxelBox {
      const VoxelIndex side(child & 1, (child >> 1) & 1, child >> 2);
      return {node.min + half * side, node.min + half * (side + VoxelIndex::Ones())};
    };
    constexpr int kChildren = 8;
    for (int child = 0; child < kChildren; ++child) {
      const int state = stateOf(child, bits);
      if (state == kFree) map_.free.push_back(boxOf(child));
      if (state == kOccupied) map_.occupied.push_back(boxOf(child));
      if (state != kUnknown) ++nodes_;
    }
    for (int child = 0; child < kChildren; ++child) {
      if (stateOf(child, bits) == kInner) read(boxOf(child));
    }
  }

  /// Read until now, with the root.
  long nodes() const { return nodes_; }

 private:
  enum State { kUnknown, kFree, kOccupied, kInner };
  static int stateOf(int child, std::uint16_t bits) { return (bits >> (2 * child)) & 3; }

  SavedMapFile& file_;
  SavedMap& map_;
  long nodes_ = 1;
};

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

SavedMap readOctomap(const std::string& path) {
  SavedMapFile file(path);
  const Header header = readOctomapHeader(&file);
  SavedMap map;
  map.resolution = header.resolution;
  if (header.nodes != 0) {
    NodeReader reader(&file, &map);
    reader.read({VoxelIndex::Constant(-kCenterKey), VoxelIndex::Constant(kCenterKey)});
    if (reader.nodes() != header.nodes) {
      file.fail("is damaged: it holds " + std::to_string(reader.nodes()) + " nodes, not the " +
                std::to_string(header.nodes) + " that it says");
    }
  }
  file.requireEnd();
  return map;
}

}  // namespace fiimap
