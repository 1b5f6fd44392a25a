#include "fiimap/sliding_grid.h"

#include <algorithm>

namespace fiimap {
namespace {

int ringSide(int columns) {
  int side = 1;
  while (side < TileRing::tilesAcross(columns)) side *= 2;
  return side;
}

int popcount(const std::uint64_t* words, int count) {
  int sum = 0;
  for (int w = 0; w < count; ++w) sum += __builtin_popcountll(words[w]);
  return sum;
}

bool isZero(const std::uint64_t* words, int count) {
  return std::all_of(words, words + count, [](std::uint64_t word) { return word == 0; });
}

}  // namespace

TileRing::TileRing(int columns_x, int columns_y)
    : mask_x_(ringSide(columns_x) - 1), mask_y_(ringSide(columns_y) - 1) {}

SlidingGrid::SlidingGrid(const VoxelIndex& size)
    : size_(size),
      window_(VoxelLattice::boxAround(VoxelIndex::Zero(), size)),
      layout_(size.z()),
      ring_(size.x(), size.y()),
      slots_(ring_.slots()),
      zero_column_(layout_.words(), 0),
      scratch_column_(layout_.words(), 0) {}

void SlidingGrid::moveTo(const VoxelIndex& min, ChangeSet* changes) {
  const VoxelBox target{min, min + size_};
  if (target == window_) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (min[axis] == window_.min[axis]) continue;
    VoxelBox entered = target;
    if (min[axis] > window_.min[axis]) {
      entered.min[axis] = std::max(target.min[axis], window_.max[axis]);
    } else {
      entered.max[axis] = std::min(target.max[axis], window_.min[axis]);
    }
    changes->entered.push_back(entered);
  }
  const VoxelBox kept = target.intersection(window_);
  // A copy, because dropping a tile edits the list.
  const std::vector<int> slots = live_;
  for (const int slot : slots) {
    const VoxelIndex& origin = slots_[slot].origin;
    const VoxelBox tile{{origin.x(), origin.y(), window_.min.z()},
                        {origin.x() + kTileSide, origin.y() + kTileSide, window_.max.z()}};
    const VoxelBox kept_here = tile.intersection(kept);
    if (kept_here == tile) continue;
    if (kept_here.empty()) {
      forgetTile(slot, &changes->forgotten);
    } else {
      forgetColumns(slot, kept, &changes->forgotten);
    }
  }
  window_ = target;
}

void SlidingGrid::forgetTile(int slot, std::vector<VoxelIndex>* forgotten) {
  const VoxelIndex origin = slots_[slot].origin;
  const int words = layout_.words();
  for (int i = 0; i < kTileColumns; ++i) {
    const int x = origin.x() + (i >> kTileShift);
    const int y = origin.y() + (i & (kTileSide - 1));
    for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
      counts_[static_cast<int>(plane)] -= popcount(column(plane, x, y), words);
    }
    forEachBit(column(Plane::kOccupied, x, y), words, [&](int bit) {
      forgotten->emplace_back(x, y, layout_.heightOf(bit, window_.min.z()));
    });
  }
  drop(slot);
}

void SlidingGrid::forgetColumns(int slot, const VoxelBox& kept,
                                std::vector<VoxelIndex>* forgotten) {
  const VoxelIndex origin = slots_[slot].origin;
  std::vector<std::uint64_t> kept_heights(layout_.words());
  heightMask(kept.min.z(), kept.max.z(), kept_heights.data());
  const bool keeps_all_heights = kept.size().z() == size_.z();
  for (int x = origin.x(); x < origin.x() + kTileSide; ++x) {
    for (int y = origin.y(); y < origin.y() + kTileSide; ++y) {
      const bool keeps_column = kept.containsColumn(x, y);
      if (keeps_column && keeps_all_heights) continue;
      forgetColumn(x, y, keeps_column ? kept_heights.data() : zero_column_.data(), forgotten);
    }
  }
}

void SlidingGrid::forgetColumn(int x, int y, const std::uint64_t* kept_heights,
                               std::vector<VoxelIndex>* forgotten) {
  const int words = layout_.words();
  // Mostly nothing leaves.
  std::uint64_t leaving = 0;
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    const std::uint64_t* bits = column(plane, x, y);
    for (int w = 0; w < words; ++w) leaving |= bits[w] & ~kept_heights[w];
  }
  if (leaving == 0) return;

  for (int w = 0; w < words; ++w) {
    scratch_column_[w] = column(Plane::kOccupied, x, y)[w] & ~kept_heights[w];
  }
  forEachBit(scratch_column_.data(), words, [&](int bit) {
    forgotten->emplace_back(x, y, layout_.heightOf(bit, window_.min.z()));
  });
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    for (int w = 0; w < words; ++w) {
      scratch_column_[w] = column(plane, x, y)[w] & kept_heights[w];
    }
    writeColumn(plane, x, y, scratch_column_.data());
  }
}

void SlidingGrid::clear() {
  while (!live_.empty()) drop(live_.back());
  std::fill(std::begin(counts_), std::end(counts_), 0);
}

void SlidingGrid::clearPlane(Plane plane) {
  for (const int slot : live_) {
    Tile& tile = writableTile(slots_[slot]);
    std::fill_n(tile.column(plane, 0, 0, layout_), kTileColumns * layout_.words(), 0);
  }
  counts_[static_cast<int>(plane)] = 0;
}

bool SlidingGrid::test(Plane plane, const VoxelIndex& v) const {
  if (!window_.contains(v)) return false;
  const int bit = layout_.bitOf(v.z());
  return (column(plane, v.x(), v.y())[bit / kWordBits] >> (bit % kWordBits)) & 1u;
}

void SlidingGrid::set(Plane plane, const VoxelIndex& v, bool value) {
  if (!window_.contains(v) || test(plane, v) == value) return;
  const int bit = layout_.bitOf(v.z());
  Tile& tile = writableTile(liveSlot(v.x(), v.y()));
  tile.column(plane, v.x(), v.y(), layout_)[bit / kWordBits] ^= std::uint64_t{1}
                                                                << (bit % kWordBits);
  counts_[static_cast<int>(plane)] += value ? 1 : -1;
}

const std::uint64_t* SlidingGrid::column(Plane plane, int x, int y) const {
  const Tile* tile = slots_[ring_.slotOf(x, y)].tile.get();
  return tile == nullptr ? zero_column_.data() : tile->column(plane, x, y, layout_);
}

void SlidingGrid::writeColumns(Plane plane, int x, int y, int columns, const std::uint64_t* words) {
  const int count = columns * layout_.words();
  if (slots_[ring_.slotOf(x, y)].tile == nullptr && isZero(words, count)) return;
  Slot& slot = liveSlot(x, y);
  const std::uint64_t* const old_words = slot.tile->column(plane, x, y, layout_);
  if (std::equal(words, words + count, old_words)) return;
  counts_[static_cast<int>(plane)] += popcount(words, count) - popcount(old_words, count);
  std::copy_n(words, count, writableTile(slot).column(plane, x, y, layout_));
}

std::int8_t* SlidingGrid::logOdds(int x, int y) {
  Slot& slot = liveSlot(x, y);
  return slot.log_odds.get() + static_cast<std::size_t>(columnInTile(x, y)) * layout_.bits();
}

void SlidingGrid::heightMask(int min_z, int max_z, std::uint64_t* words) const {
  std::fill_n(words, layout_.words(), 0);
  for (int z = std::max(min_z, window_.min.z()); z < std::min(max_z, window_.max.z()); ++z) {
    const int bit = layout_.bitOf(z);
    words[bit / kWordBits] |= std::uint64_t{1} << (bit % kWordBits);
  }
}

std::vector<std::shared_ptr<const Tile>> SlidingGrid::shareTiles() {
  ++generation_;
  std::vector<std::shared_ptr<const Tile>> tiles(slots_.size());
  for (const int slot : live_) tiles[slot] = slots_[slot].tile;
  return tiles;
}

SlidingGrid::Slot& SlidingGrid::liveSlot(int x, int y) {
  const int index = ring_.slotOf(x, y);
  Slot& slot = slots_[index];
  if (slot.tile != nullptr) return slot;
  slot.tile = std::make_shared<Tile>(layout_);
  slot.tile->generation = generation_;
  slot.origin = {x & ~(kTileSide - 1), y & ~(kTileSide - 1), 0};
  if (spare_log_odds_.empty()) {
    slot.log_odds.reset(new std::int8_t[static_cast<std::size_t>(kTileColumns) * layout_.bits()]);
  } else {
    slot.log_odds = std::move(spare_log_odds_.back());
    spare_log_odds_.pop_back();
  }
  slot.live_position = live_.size();
  live_.push_back(index);
  return slot;
}

Tile& SlidingGrid::writableTile(Slot& slot) {
  if (slot.tile->generation != generation_) {
    slot.tile = std::make_shared<Tile>(*slot.tile);
    slot.tile->generation = generation_;
  }
  return *slot.tile;
}

void SlidingGrid::drop(int slot_index) {
  Slot& slot = slots_[slot_index];
  slot.tile.reset();
  spare_log_odds_.push_back(std::move(slot.log_odds));
  const int moved = live_.back();
  live_[slot.live_position] = moved;
  slots_[moved].live_position = slot.live_position;
  live_.pop_back();
}

std::size_t SlidingGrid::logOddsBytes() const {
  return static_cast<std::size_t>(kTileColumns) * layout_.bits();
}

std::size_t SlidingGrid::tileBytes() const {
  const std::size_t planes = sizeof(std::uint64_t) * kPlaneCount * kTileColumns * layout_.words();
  return planes + logOddsBytes();
}

std::size_t SlidingGrid::memoryBytes() const {
  return slots_.size() * sizeof(Slot) + live_.size() * tileBytes() +
         spare_log_odds_.size() * logOddsBytes();
}

std::size_t SlidingGrid::worstCaseMemoryBytes() const {
  const std::size_t tiles_x = TileRing::tilesAcross(size_.x());
  const std::size_t tiles_y = TileRing::tilesAcross(size_.y());
  return slots_.size() * sizeof(Slot) + tiles_x * tiles_y * tileBytes();
}

}  // namespace fiimap
