#include "fiimap/scan_integrator.h"

#include <algorithm>
#include <array>

namespace fiimap {
namespace {

/// Moves the bits of columns that start at height bit 0 to their place in the ring.
void rotateIntoRing(const std::uint64_t* columns, int count, int column_words, int first_bit,
                    int ring_words, std::uint64_t* ring) {
  const int shift = first_bit % kWordBits;
  if (ring_words == 1) {
    for (int c = 0; c < count; ++c) {
      ring[c] = (columns[c] << shift) | (columns[c] >> (-shift & (kWordBits - 1)));
    }
    return;
  }
  const auto wordAt = [&](int w) {
    w &= ring_words - 1;
    return w < column_words ? columns[w] : 0;
  };
  for (int c = 0; c < count; ++c, columns += column_words, ring += ring_words) {
    for (int w = 0; w < ring_words; ++w) {
      const int source = w - first_bit / kWordBits;
      // In two steps, because a word cannot be shifted by all its bits.
      const std::uint64_t below = wordAt(source - 1) >> 1 >> (kWordBits - 1 - shift);
      ring[w] = (wordAt(source) << shift) | below;
    }
  }
}

bool anyBit(const std::uint64_t* words, int count) {
  std::uint64_t any = 0;
  for (int w = 0; w < count; ++w) any |= words[w];
  return any != 0;
}

constexpr int kByteValues = 256;

/// By the byte of a log-odds, what it becomes in another scale.
std::array<std::int8_t, kByteValues> conversionTable(const LogOdds& from, const LogOdds& to) {
  std::array<std::int8_t, kByteValues> table{};
  for (int byte = 0; byte < kByteValues; ++byte) {
    table[byte] = to.convert(static_cast<std::int8_t>(static_cast<std::uint8_t>(byte)), from);
  }
  return table;
}

}  // namespace

void ScanIntegrator::apply(const ScanMask& mask, SlidingGrid* grid, ChangeSet* changes) {
  const std::size_t row_words = static_cast<std::size_t>(kTileSide) * grid->layout().words();
  for (auto* row : {&hit_, &free_, &known_, &occupied_}) row->resize(row_words);
  const VoxelBox& touched = mask.touched();
  for (int x = touched.min.x(); x < touched.max.x(); ++x) {
    for (int y = touched.min.y(); y < touched.max.y();) {
      const int in_tile = (mask.box().min.y() + y) & (kTileSide - 1);
      const int columns = std::min(kTileSide - in_tile, touched.max.y() - y);
      const int words = columns * mask.wordsPerColumn();
      if (anyBit(mask.column(ScanMask::kFree, x, y), words) ||
          anyBit(mask.column(ScanMask::kHit, x, y), words)) {
        applyRow(mask, x, y, columns, grid, changes);
      }
      y += columns;
    }
  }
}

/// Columns side by side along y, in one tile: their words and log-odds lie side by side, too.
void ScanIntegrator::applyRow(const ScanMask& mask, int mask_x, int mask_y, int columns,
                              SlidingGrid* grid, ChangeSet* changes) {
  const ColumnLayout& layout = grid->layout();
  const int x = mask.box().min.x() + mask_x;
  const int y = mask.box().min.y() + mask_y;
  const int first_bit = layout.bitOf(mask.box().min.z());
  rotateIntoRing(mask.column(ScanMask::kHit, mask_x, mask_y), columns, mask.wordsPerColumn(),
                 first_bit, layout.words(), hit_.data());
  rotateIntoRing(mask.column(ScanMask::kFree, mask_x, mask_y), columns, mask.wordsPerColumn(),
                 first_bit, layout.words(), free_.data());

  std::int8_t* const log_odds = grid->logOdds(x, y);  // makes the tile, if there is none
  const std::uint64_t* const known_before = grid->column(Plane::kKnown, x, y);
  const std::uint64_t* const occupied_before = grid->column(Plane::kOccupied, x, y);
  const int words = columns * layout.words();
  for (int w = 0; w < words; ++w) {
    free_[w] &= ~hit_[w];
    known_[w] = known_before[w] | hit_[w] | free_[w];
    occupied_[w] = occupied_before[w];
  }
  kernels_.observe(log_odds_, words, hit_.data(), free_.data(), known_before, occupied_.data(),
                   log_odds);
  listFlips(x, y, occupied_before, words, *grid, changes);
  grid->writeColumns(Plane::kKnown, x, y, columns, known_.data());
  grid->writeColumns(Plane::kOccupied, x, y, columns, occupied_.data());
  grid->markSeen(x, y, columns, hit_.data());
  grid->markSeen(x, y, columns, free_.data());
}

void ScanIntegrator::convert(const LogOdds& from, SlidingGrid* grid, ChangeSet* changes) {
  if (from == log_odds_) return;
  const auto converted = conversionTable(from, log_odds_);
  occupied_.resize(static_cast<std::size_t>(kTileSide) * grid->layout().words());
  for (const int slot : grid->liveSlots()) {
    const VoxelIndex origin = grid->tileOrigin(slot);
    for (int x = origin.x(); x < origin.x() + kTileSide; ++x) {
      convertRow(converted.data(), x, origin.y(), grid, changes);
    }
  }
}

/// The columns of a tile at one x.
void ScanIntegrator::convertRow(const std::int8_t* converted, int x, int y, SlidingGrid* grid,
                                ChangeSet* changes) {
  const int words = kTileSide * grid->layout().words();
  std::int8_t* const log_odds = grid->logOdds(x, y);
  const std::uint64_t* const known = grid->column(Plane::kKnown, x, y);
  for (int w = 0; w < words; ++w) {
    occupied_[w] = 0;
    forEachBit(&known[w], 1, [&](int bit) {
      std::int8_t& value = log_odds[w * kWordBits + bit];
      value = converted[static_cast<std::uint8_t>(value)];
      const std::uint64_t is_occupied = value >= log_odds_.threshold ? 1 : 0;
      occupied_[w] |= is_occupied << bit;
    });
  }
  listFlips(x, y, grid->column(Plane::kOccupied, x, y), words, *grid, changes);
  grid->writeColumns(Plane::kOccupied, x, y, kTileSide, occupied_.data());
}

/// Appends the voxels of a row whose state is not what it was.
void ScanIntegrator::listFlips(int x, int y, const std::uint64_t* occupied_before, int words,
                               const SlidingGrid& grid, ChangeSet* changes) const {
  const ColumnLayout& layout = grid.layout();
  for (int w = 0; w < words; ++w) {
    const std::uint64_t flipped = occupied_[w] ^ occupied_before[w];
    forEachBit(&flipped, 1, [&](int bit) {
      const bool is_occupied = (occupied_[w] >> bit) & 1u;
      const int ring_bit = w % layout.words() * kWordBits + bit;
      const int z = layout.heightOf(ring_bit, grid.window().min.z());
      (is_occupied ? changes->lower : changes->raise).emplace_back(x, y + w / layout.words(), z);
    });
  }
}

}  // namespace fiimap
