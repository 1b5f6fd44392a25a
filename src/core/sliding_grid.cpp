#include "fiimap/sliding_grid.h"

#include <algorithm>

namespace fiimap {
namespace {

/// By `bits` modulo those of a word.
std::uint64_t rotatedLeft(std::uint64_t word, int bits) {
  return word << (bits & (kWordBits - 1)) | word >> (-bits & (kWordBits - 1));
}

int ringSide(int columns) {
  int side = 1;
  while (side < TileRing::tilesAcross(columns)) side *= 2;
  return side;
}

}  // namespace

TileRing::TileRing(int columns_x, int columns_y)
    : mask_x_(ringSide(columns_x) - 1), mask_y_(ringSide(columns_y) - 1) {}

SlidingGrid::SlidingGrid(const VoxelIndex& size)
    : size_(size),
      window_(VoxelLattice::boxAround(VoxelIndex::Zero(), size)),
      layout_(size.z()),
      ring_(size.x(), size.y()),
      kernels_(kernels()),
      slots_(ring_.slots()),
      zero_row_(static_cast<std::size_t>(kTileSide) * layout_.words(), 0) {}

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
      forgetOutside(kept, slot, &changes->forgotten);
    }
  }
  window_ = target;
}

void SlidingGrid::forgetTile(int slot, std::vector<VoxelIndex>* forgotten) {
  if (slots_[slot].counts[static_cast<int>(Plane::kOccupied)] > 0) {
    const VoxelIndex origin = slots_[slot].origin;
    for (int x = origin.x(); x < origin.x() + kTileSide; ++x) {
      const std::uint64_t* const row = column(Plane::kOccupied, x, origin.y());
      for (int w = 0; w < kTileSide * layout_.words(); ++w) {
        if (row[w] != 0) listObstacles(row[w], w, x, origin.y(), forgotten);
      }
    }
  }
  drop(slot);
}

/// Clears what is not kept of a tile.
void SlidingGrid::forgetOutside(const VoxelBox& kept, int slot,
                                std::vector<VoxelIndex>* forgotten) {
  const VoxelIndex origin = slots_[slot].origin;
  const int words = layout_.words();
  std::vector<std::uint64_t> kept_row(zero_row_.size(), 0);
  const int first_y = std::max(kept.min.y(), origin.y());
  const int end_y = std::min(kept.max.y(), origin.y() + kTileSide);
  for (int y = first_y; y < end_y; ++y) {
    std::uint64_t* const column = kept_row.data() + (y - origin.y()) * words;
    if (y == first_y) heightMask(kept.min.z(), kept.max.z(), column);
    if (y > first_y) std::copy_n(column - words, words, column);
  }
  for (int x = origin.x(); x < origin.x() + kTileSide; ++x) {
    const bool keeps_row = x >= kept.min.x() && x < kept.max.x();
    for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
      forgetRow(plane, x, (keeps_row ? kept_row : zero_row_).data(), &slots_[slot], forgotten);
    }
  }
}

/// Clears the bits that are not in `kept` of the columns of a tile at one x.
void SlidingGrid::forgetRow(Plane plane, int x, const std::uint64_t* kept, Slot* slot,
                            std::vector<VoxelIndex>* forgotten) {
  const int words = kTileSide * layout_.words();
  const int y = slot->origin.y();
  const std::size_t offset = offsetInTile(plane, x, y, layout_);
  const std::uint64_t* const row = slot->tile.get() + offset;
  std::uint64_t any_leaving = 0;
  for (int w = 0; w < words; ++w) any_leaving |= row[w] & ~kept[w];
  if (any_leaving == 0) return;  // mostly

  std::uint64_t* const target = writableTile(slot) + offset;
  for (int w = 0; w < words; ++w) {
    const std::uint64_t leaving = target[w] & ~kept[w];
    if (leaving == 0) continue;
    slot->counts[static_cast<int>(plane)] -= countBits(leaving);
    if (plane == Plane::kOccupied) listObstacles(leaving, w, x, y, forgotten);
    target[w] ^= leaving;
  }
}

/// Appends the voxels of word w of the columns that begin at (x, y) and go on along y.
void SlidingGrid::listObstacles(std::uint64_t word, int w, int x, int y,
                                std::vector<VoxelIndex>* obstacles) const {
  const int first_bit = w % layout_.words() * kWordBits;
  forEachBit(&word, 1, [&](int bit) {
    const int z = layout_.heightOf(first_bit + bit, window_.min.z());
    obstacles->emplace_back(x, y + w / layout_.words(), z);
  });
}

void SlidingGrid::clear() {
  while (!live_.empty()) drop(live_.back());
}

void SlidingGrid::clearPlane(Plane plane) {
  for (const int index : live_) {
    Slot& slot = slots_[index];
    if (slot.counts[static_cast<int>(plane)] == 0) continue;
    std::uint64_t* const words = writableTile(&slot);
    std::fill_n(words + offsetInTile(plane, 0, 0, layout_), planeWords(layout_), 0);
    slot.counts[static_cast<int>(plane)] = 0;
  }
}

std::int64_t SlidingGrid::count(Plane plane) const {
  std::int64_t voxels = 0;
  for (const int slot : live_) voxels += slots_[slot].counts[static_cast<int>(plane)];
  return voxels;
}

bool SlidingGrid::test(Plane plane, const VoxelIndex& v) const {
  if (!window_.contains(v)) return false;
  const int bit = layout_.bitOf(v.z());
  return (column(plane, v.x(), v.y())[bit / kWordBits] >> (bit % kWordBits)) & 1u;
}

void SlidingGrid::set(Plane plane, const VoxelIndex& v, bool value) {
  if (!window_.contains(v) || test(plane, v) == value) return;
  const int bit = layout_.bitOf(v.z());
  Slot& slot = liveSlot(v.x(), v.y());
  std::uint64_t* const words = writableTile(&slot) + offsetInTile(plane, v.x(), v.y(), layout_);
  words[bit / kWordBits] ^= std::uint64_t{1} << (bit % kWordBits);
  slot.counts[static_cast<int>(plane)] += value ? 1 : -1;
}

std::int8_t* SlidingGrid::logOdds(int x, int y) {
  Slot& slot = liveSlot(x, y);
  return slot.log_odds.get() + static_cast<std::size_t>(columnInTile(x, y)) * layout_.bits();
}

void SlidingGrid::keepSeen(bool keep) {
  keeps_seen_ = keep;
  for (const int index : live_) {
    Slot& slot = slots_[index];
    slot.seen.reset();
    if (!keep) continue;
    slot.seen.reset(new std::uint64_t[planeWords(layout_)]);
    const std::uint64_t* const known = slot.tile.get() + offsetInTile(Plane::kKnown, 0, 0, layout_);
    std::copy_n(known, planeWords(layout_), slot.seen.get());
  }
}

void SlidingGrid::markSeen(int x, int y, int columns, const std::uint64_t* voxels) {
  std::uint64_t* const plane = slots_[ring_.slotOf(x, y)].seen.get();
  if (plane == nullptr) return;
  const int words = layout_.words();
  std::uint64_t* const seen = plane + static_cast<std::size_t>(columnInTile(x, y)) * words;
  for (int w = 0; w < columns * words; ++w) seen[w] |= voxels[w];
}

void SlidingGrid::forgetUnseen(int index, std::vector<VoxelIndex>* obstacles) {
  Slot& slot = slots_[index];
  if (slot.seen == nullptr) return;
  if (std::all_of(std::begin(slot.counts), std::end(slot.counts), [](int n) { return n == 0; })) {
    drop(index);
    return;
  }
  const int row_words = kTileSide * layout_.words();
  for (int row = 0; row < kTileSide; ++row) {
    const std::uint64_t* const seen = slot.seen.get() + static_cast<std::size_t>(row) * row_words;
    for (const Plane plane : {Plane::kKnown, Plane::kOccupied}) {
      forgetRow(plane, slot.origin.x() + row, seen, &slot, obstacles);
    }
  }
  std::fill_n(slot.seen.get(), planeWords(layout_), 0);
}

void SlidingGrid::heightMask(int min_z, int max_z, std::uint64_t* words) const {
  const int end_z = std::min(max_z, window_.max.z());
  int z = std::max(min_z, window_.min.z());
  if (layout_.words() == 1) {  // by the loop below: two and a half times the instructions
    *words = z < end_z ? rotatedLeft(~std::uint64_t{0} >> (kWordBits - (end_z - z)), z) : 0;
    return;
  }
  std::fill_n(words, layout_.words(), 0);
  while (z < end_z) {
    const int bit = layout_.bitOf(z);
    const int first = bit % kWordBits;
    const int count = std::min(kWordBits - first, end_z - z);  // heights in this word
    words[bit / kWordBits] |= ~std::uint64_t{0} >> (kWordBits - count) << first;
    z += count;
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
  slot.tile.reset(new std::uint64_t[tileWords(layout_)]());
  slot.generation = generation_;
  slot.origin = {tileFloor(x), tileFloor(y), 0};
  if (spare_log_odds_.empty()) {
    slot.log_odds.reset(new std::int8_t[logOddsBytes()]);
  } else {
    slot.log_odds = std::move(spare_log_odds_.back());
    spare_log_odds_.pop_back();
  }
  if (keeps_seen_) slot.seen.reset(new std::uint64_t[planeWords(layout_)]());
  slot.live_position = live_.size();
  live_.push_back(index);
  return slot;
}

std::uint64_t* SlidingGrid::writableTile(Slot* slot) {
  if (slot->generation != generation_) {
    const std::shared_ptr<Tile> copy(new std::uint64_t[tileWords(layout_)]);
    std::copy_n(slot->tile.get(), tileWords(layout_), copy.get());
    slot->tile = copy;
    slot->generation = generation_;
  }
  return slot->tile.get();
}

void SlidingGrid::drop(int slot_index) {
  Slot& slot = slots_[slot_index];
  slot.tile.reset();
  slot.seen.reset();
  std::fill(std::begin(slot.counts), std::end(slot.counts), 0);
  spare_log_odds_.push_back(std::move(slot.log_odds));
  const int moved = live_.back();
  live_[slot.live_position] = moved;
  slots_[moved].live_position = slot.live_position;
  live_.pop_back();
}

std::size_t SlidingGrid::logOddsBytes(const ColumnLayout& layout) {
  return static_cast<std::size_t>(kTileColumns) * layout.bits();
}

std::size_t SlidingGrid::tileBytes(const ColumnLayout& layout, bool keeps_seen) {
  const std::size_t words = tileWords(layout) + (keeps_seen ? planeWords(layout) : 0);
  return words * sizeof(std::uint64_t) + logOddsBytes(layout);
}

std::size_t SlidingGrid::memoryBytes() const {
  return slots_.size() * sizeof(Slot) + live_.size() * tileBytes() +
         spare_log_odds_.size() * logOddsBytes();
}

std::size_t SlidingGrid::worstCaseMemoryBytes(const VoxelIndex& size, bool keeps_seen) {
  const std::size_t tiles_x = TileRing::tilesAcross(size.x());
  const std::size_t tiles_y = TileRing::tilesAcross(size.y());
  const std::size_t slots = TileRing(size.x(), size.y()).slots();
  return slots * sizeof(Slot) + tiles_x * tiles_y * tileBytes(ColumnLayout(size.z()), keeps_seen);
}

}  // namespace fiimap
