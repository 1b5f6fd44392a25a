#include "search_nodes.h"

#include <algorithm>

namespace fiimap {
namespace {

constexpr int kCoordinateBits = 20;
constexpr std::uint64_t kCoordinateMask = (1u << kCoordinateBits) - 1;
constexpr std::uint64_t kHashFactor =
    0x9E3779B97F4A7C15u;  // 2^64 / golden ratio: spreads neighbours
constexpr int kHashShift = 32;
constexpr int kBlockBits =
    2;  // voxels above each other in blocks of four share a line of the cache

std::uint64_t keyOf(const VoxelIndex& v) {
  return (static_cast<std::uint64_t>(v.x()) << (2 * kCoordinateBits)) |
         (static_cast<std::uint64_t>(v.y()) << kCoordinateBits) | static_cast<std::uint64_t>(v.z());
}

bool comesLater(const SearchNodes::Entry& a, const SearchNodes::Entry& b) {
  return a.estimate != b.estimate ? a.estimate > b.estimate : a.heuristic > b.heuristic;
}

}  // namespace

SearchNodes::SearchNodes(std::size_t capacity) : capacity_(capacity) {
  // At most half full, so that few slots have to be looked at.
  std::size_t slots = 1;
  while (slots < 2 * capacity) slots *= 2;
  nodes_.resize(slots);
  mask_ = slots - 1;
  heap_.reserve(capacity);
}

void SearchNodes::clear() {
  heap_.clear();
  count_ = 0;
  ++generation_;
  if (generation_ != 0) return;
  std::fill(nodes_.begin(), nodes_.end(), Node());
  generation_ = 1;
}

std::uint32_t SearchNodes::slotOf(std::uint64_t key) const {
  const std::uint64_t block = (key >> kBlockBits) * kHashFactor >> kHashShift;
  std::uint64_t slot = ((block << kBlockBits) | (key & ((1u << kBlockBits) - 1))) & mask_;
  while (nodes_[slot].generation == generation_ && nodes_[slot].voxel != key) {
    slot = (slot + 1) & mask_;
  }
  return static_cast<std::uint32_t>(slot);
}

SearchNodes::Node* SearchNodes::get(const VoxelIndex& v, bool* is_new) {
  const std::uint64_t key = keyOf(v);
  Node& node = nodes_[slotOf(key)];
  *is_new = node.generation != generation_;
  if (!*is_new) return &node;
  if (count_ == capacity_) return nullptr;
  ++count_;
  node = Node();
  node.voxel = key;
  node.generation = generation_;
  return &node;
}

const SearchNodes::Node* SearchNodes::find(const VoxelIndex& v) const {
  const Node& node = nodes_[slotOf(keyOf(v))];
  return node.generation == generation_ ? &node : nullptr;
}

void SearchNodes::push(const Node& node, std::int64_t heuristic) {
  heap_.push_back(
      {node.cost + heuristic, heuristic, static_cast<std::uint32_t>(&node - nodes_.data())});
  std::push_heap(heap_.begin(), heap_.end(), comesLater);
}

SearchNodes::Entry SearchNodes::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), comesLater);
  const Entry entry = heap_.back();
  heap_.pop_back();
  return entry;
}

VoxelIndex SearchNodes::voxelOf(const Node& node) {
  return {static_cast<int>(node.voxel >> (2 * kCoordinateBits)),
          static_cast<int>((node.voxel >> kCoordinateBits) & kCoordinateMask),
          static_cast<int>(node.voxel & kCoordinateMask)};
}

}  // namespace fiimap
