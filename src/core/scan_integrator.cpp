#include "fiimap/scan_integrator.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fiimap {
namespace {

/// Eight voxels at a time: the bytes of a 64-bit word, 0xff where a bit of `bits` is set.
std::uint64_t spreadBits(std::uint8_t bits) {
  static const std::array<std::uint64_t, 256> table = [] {
    std::array<std::uint64_t, 256> masks{};
    for (int value = 0; value < 256; ++value) {
      for (int bit = 0; bit < 8; ++bit) {
        if ((value >> bit) & 1) masks[value] |= std::uint64_t{0xff} << (8 * bit);
      }
    }
    return masks;
  }();
  return table[bits];
}

constexpr int kGroup = 8;

/// One byte, eight times.
std::uint64_t repeat(std::int8_t value) {
  constexpr std::uint64_t kEveryByte = 0x0101010101010101;
  return kEveryByte * static_cast<std::uint8_t>(value);
}

/// Updates the log-odds of the voxels in `hit` and `free` (disjoint). Unknown voxels start at the
/// prior, 0, whatever their byte holds. `occupied` holds their state and is updated.
void updateGroup(const LogOdds& l, std::uint8_t hit, std::uint8_t free, std::uint8_t known,
                 std::int8_t* log_odds, std::uint8_t* occupied) {
  std::uint64_t before;
  std::memcpy(&before, log_odds, kGroup);
  before &= spreadBits(known);
  const std::uint8_t observed = hit | free;
  const std::uint64_t observed_bytes = spreadBits(observed);
  // Most voxels that a scan sees are known to be free and as certainly so as can be: another miss
  // changes nothing.
  const bool all_misses_of_known_voxels = hit == 0 && (observed & ~known) == 0;
  if (all_misses_of_known_voxels && ((before ^ repeat(l.min)) & observed_bytes) == 0) return;

  const std::uint64_t hit_bytes = spreadBits(hit);
  std::int8_t value[kGroup], is_hit[kGroup], is_observed[kGroup];
  std::memcpy(value, &before, kGroup);
  std::memcpy(is_hit, &hit_bytes, kGroup);
  std::memcpy(is_observed, &observed_bytes, kGroup);
  std::uint8_t above = 0;
  for (int i = 0; i < kGroup; ++i) {
    const int change = is_hit[i] != 0 ? l.hit : l.miss;
    const int after = std::clamp<int>(value[i] + change, l.min, l.max);
    value[i] = static_cast<std::int8_t>(is_observed[i] != 0 ? after : value[i]);
    above |= static_cast<std::uint8_t>((value[i] >= l.threshold ? 1 : 0) << i);
  }
  std::memcpy(log_odds, value, kGroup);
  *occupied = static_cast<std::uint8_t>((*occupied & ~observed) | (above & observed));
}

/// Moves bits of a column that starts at height bit 0 to their place in the ring.
void rotateIntoRing(const std::uint64_t* column, int column_words, int first_bit,
                    std::vector<std::uint64_t>* ring) {
  std::fill(ring->begin(), ring->end(), 0);
  const int words = static_cast<int>(ring->size());
  const int shift = first_bit % kWordBits;
  for (int w = 0; w < column_words; ++w) {
    const int target = first_bit / kWordBits + w;
    (*ring)[target % words] |= column[w] << shift;
    if (shift != 0) (*ring)[(target + 1) % words] |= column[w] >> (kWordBits - shift);
  }
}

}  // namespace

void ScanIntegrator::apply(const ScanMask& mask, SlidingGrid* grid, ChangeSet* changes) {
  for (auto* ring : {&hit_, &free_, &known_, &occupied_}) ring->resize(grid->layout().words());
  const VoxelBox& touched = mask.touched();
  for (int x = touched.min.x(); x < touched.max.x(); ++x) {
    for (int y = touched.min.y(); y < touched.max.y(); ++y) {
      if (mask.any(ScanMask::kFree, x, y) || mask.any(ScanMask::kHit, x, y)) {
        applyColumn(mask, x, y, grid, changes);
      }
    }
  }
}

void ScanIntegrator::applyColumn(const ScanMask& mask, int mask_x, int mask_y, SlidingGrid* grid,
                                 ChangeSet* changes) {
  const int x = mask.box().min.x() + mask_x;
  const int y = mask.box().min.y() + mask_y;
  const int first_bit = grid->layout().bitOf(mask.box().min.z());
  rotateIntoRing(mask.column(ScanMask::kHit, mask_x, mask_y), mask.wordsPerColumn(), first_bit,
                 &hit_);
  rotateIntoRing(mask.column(ScanMask::kFree, mask_x, mask_y), mask.wordsPerColumn(), first_bit,
                 &free_);

  std::int8_t* log_odds = grid->logOdds(x, y);
  const std::uint64_t* known_before = grid->column(Plane::kKnown, x, y);
  const std::uint64_t* occupied_before = grid->column(Plane::kOccupied, x, y);
  const int words = grid->layout().words();
  for (int w = 0; w < words; ++w) {
    free_[w] &= ~hit_[w];
    known_[w] = known_before[w] | hit_[w] | free_[w];
    occupied_[w] = occupied_before[w];
    const std::uint64_t observed = hit_[w] | free_[w];
    for (int shift = 0; shift < kWordBits; shift += kGroup) {
      if (((observed >> shift) & 0xff) == 0) continue;
      std::uint8_t occupied = occupied_[w] >> shift;
      updateGroup(log_odds_, hit_[w] >> shift, free_[w] >> shift, known_before[w] >> shift,
                  log_odds + w * kWordBits + shift, &occupied);
      occupied_[w] &= ~(std::uint64_t{0xff} << shift);
      occupied_[w] |= std::uint64_t{occupied} << shift;
    }
  }

  for (int w = 0; w < words; ++w) {
    const std::uint64_t flipped = occupied_[w] ^ occupied_before[w];
    forEachBit(&flipped, 1, [&](int bit) {
      const bool is_occupied = (occupied_[w] >> bit) & 1u;
      const int z = grid->layout().heightOf(w * kWordBits + bit, grid->window().min.z());
      (is_occupied ? changes->lower : changes->raise).emplace_back(x, y, z);
    });
  }
  grid->writeColumn(Plane::kKnown, x, y, known_.data());
  grid->writeColumn(Plane::kOccupied, x, y, occupied_.data());
}

}  // namespace fiimap
