#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What a search knows of the voxels that it met, and which to look at next. Of fixed size: a hash
/// table with open addressing that empties itself by counting generations, and a binary heap.
class SearchNodes {
 public:
  struct Node {
    std::uint64_t voxel = 0;
    std::int64_t cost = 0;         ///< of the best way there so far
    std::uint32_t generation = 0;  ///< of the search that wrote it
    std::int8_t step = 0;          ///< by which it was reached, as an index of the caller
    bool done = false;
  };
  /// A node that waits; of equal estimates, the one nearer to the goal comes first.
  struct Entry {
    std::int64_t estimate;  ///< cost + heuristic
    std::int64_t heuristic;
    std::uint32_t slot;
  };

  /// \param capacity largest number of nodes.
  explicit SearchNodes(std::size_t capacity);

  /// Forgets all nodes.
  void clear();

  /// The node of a voxel, whose coordinates must be in [0, 2^20); null when it was not met and the
  /// table is full.
  Node* get(const VoxelIndex& v, bool* is_new);
  const Node* find(const VoxelIndex& v) const;
  Node& at(std::uint32_t slot) { return nodes_[slot]; }

  void push(const Node& node, std::int64_t heuristic);
  bool empty() const { return heap_.empty(); }
  Entry pop();

  static VoxelIndex voxelOf(const Node& node);

 private:
  std::uint32_t slotOf(std::uint64_t key) const;

  std::vector<Node> nodes_;
  std::vector<Entry> heap_;
  std::uint32_t generation_ = 0;
  std::size_t count_ = 0;
  std::size_t capacity_;
  std::uint64_t mask_;
};

}  // namespace fiimap
