#include <algorithm>

#include "fiimap/snapshot.h"

namespace fiimap {
namespace {

/// Turns the ring of a column so that bit 0 is the voxel at min_z.
void turn(const std::uint64_t* ring, const ColumnLayout& layout, int min_z, std::uint64_t* column) {
  const int first = layout.bitOf(min_z) / kWordBits, shift = layout.bitOf(min_z) % kWordBits;
  const int last = layout.words() - 1;  // a mask, too
  for (int w = 0; w <= last; ++w) {
    column[w] = ring[(first + w) & last] >> shift;
    if (shift > 0) column[w] |= ring[(first + w + 1) & last] << (kWordBits - shift);
  }
}

/// Clears all bits but [first, end) of a column.
void keep(int first, int end, std::vector<std::uint64_t>* column) {
  int begin = 0;  // first bit of the word
  for (std::uint64_t& word : *column) {
    const int low = std::clamp(first - begin, 0, kWordBits);
    const int count = std::clamp(end - begin, low, kWordBits) - low;
    word &= count == 0 ? 0 : ~std::uint64_t{0} >> (kWordBits - count) << low;
    begin += kWordBits;
  }
}

}  // namespace

std::vector<VoxelRun> Snapshot::changes(Plane plane, const Snapshot* before) const {
  std::vector<VoxelRun> runs;
  const VoxelBox kept = before == nullptr ? VoxelBox() : window().intersection(before->window());
  const int first_tile = window().min.x() & ~(kTileSide - 1);
  for (int tile_x = first_tile; tile_x < window().max.x(); tile_x += kTileSide) {
    const std::vector<ChangedTile> tiles = changedTiles(tile_x, before);
    if (tiles.empty()) continue;  // mostly
    const int end_x = std::min(tile_x + kTileSide, window().max.x());
    for (int x = std::max(tile_x, window().min.x()); x < end_x; ++x) {
      for (const ChangedTile& tile : tiles) appendChanges(plane, kept, x, tile, &runs);
    }
  }
  return runs;
}

/// Of those at one tile_x, in the order of y. A tile that both snapshots share has kept all of its
/// voxels, because clearing one would have made a copy of it.
std::vector<Snapshot::ChangedTile> Snapshot::changedTiles(int tile_x,
                                                          const Snapshot* before) const {
  std::vector<ChangedTile> changed;
  const int first_tile = window().min.y() & ~(kTileSide - 1);
  for (int tile_y = first_tile; tile_y < window().max.y(); tile_y += kTileSide) {
    const std::uint64_t* const then = before != nullptr && before->touches(tile_x, tile_y)
                                          ? before->tileAt(tile_x, tile_y)
                                          : nullptr;
    const std::uint64_t* const now = tileAt(tile_x, tile_y);
    if (then == now) continue;
    changed.push_back({std::max(tile_y, window().min.y()),
                       std::min(tile_y + kTileSide, window().max.y()), then, now});
  }
  return changed;
}

/// \param kept what both windows have in common.
void Snapshot::appendChanges(Plane plane, const VoxelBox& kept, int x, const ChangedTile& tile,
                             std::vector<VoxelRun>* runs) const {
  const int min_z = window().min.z();
  std::vector<std::uint64_t> changed(layout_.words()), then(layout_.words());
  for (int y = tile.first_y; y < tile.end_y; ++y) {
    const std::size_t offset = offsetInTile(plane, x, y, layout_);
    std::fill(changed.begin(), changed.end(), 0);
    if (tile.now != nullptr) turn(tile.now + offset, layout_, min_z, changed.data());
    if (tile.then != nullptr) {
      turn(tile.then + offset, layout_, min_z, then.data());
      keep(kept.min.z() - min_z, kept.max.z() - min_z, &then);
      for (std::size_t w = 0; w < then.size(); ++w) changed[w] ^= then[w];
    }
    forEachRun(changed.data(), layout_.words(), [&](int first, int last) {
      runs->push_back({{x, y, min_z + first}, last - first + 1});
    });
  }
}

}  // namespace fiimap
