#include "fiimap/hit_cover.h"

#include <cmath>

namespace fiimap {
namespace {

constexpr std::int32_t kNoVoxel = -1;
/// No point of a voxel is farther from its centre, voxel edges.
constexpr double kHalfDiagonal = 0.8661;

}  // namespace

std::size_t HitCover::dropSlivers(const RangeData& scan, const RayEnds& ends,
                                  const Eigen::Vector3f& origin, double resolution,
                                  ScanMask* mask) {
  // A face at a distance of d voxel edges fills 1 / d^2 steradian.
  const double least = min_cover_ * scan.returns_per_steradian;
  if (!(least > 0.0)) return 0;
  const double one_suffices = (std::sqrt(least) + kHalfDiagonal) * resolution;  // m
  listPassed(ends, *mask);
  listNear(ends, scan.returns, static_cast<float>(one_suffices * one_suffices));
  countReturns(ends, *mask);
  std::uint64_t* const hit = mask->column(ScanMask::kHit, 0, 0);
  std::size_t dropped = 0;
  for (const Voxel& voxel : voxels_) {
    const VoxelIndex v = mask->voxelAt(voxel.word, voxel.bit);
    const Eigen::Vector3f center = v.cast<float>().array() + 0.5f;
    const float cover = static_cast<float>(voxel.returns) * (center - origin).squaredNorm();
    if (cover >= static_cast<float>(least)) continue;
    hit[voxel.word] &= ~(std::uint64_t{1} << voxel.bit);
    ++dropped;
  }
  return dropped;
}

/// The ends in free voxels.
void HitCover::listPassed(const RayEnds& ends, const ScanMask& mask) {
  ends_.resize(ends.size + kVectorRoom);
  ends_.resize(kernels_.selectEnds(ends, 0, ends.size, mask.bits(ScanMask::kFree), true,
                                   ends_.data()));
}

/// Of those listed, the ends of rays that are not so long that one return is cover enough.
void HitCover::listNear(const RayEnds& ends, const PointList& returns, float max_length_2) {
  std::size_t size = 0;
  for (const std::int32_t k : ends_) {
    ends_[size] = k;
    size += returns[ends.first[k]].squaredNorm() < max_length_2 ? 1 : 0;
  }
  ends_.resize(size);
}

void HitCover::countReturns(const RayEnds& ends, const ScanMask& mask) {
  constexpr std::size_t kSmallest = 64;
  std::size_t size = kSmallest;
  while (size < 2 * ends_.size()) size *= 2;
  table_.assign(size, kNoVoxel);
  voxels_.clear();
  for (const std::int32_t k : ends_) {
    const std::int32_t column = mask.columnOffset(ends.x[k], ends.y[k]);
    Voxel& voxel = find(column + ends.z[k] / kWordBits, ends.z[k] % kWordBits);
    voxel.returns += ends.first[k + 1] - ends.first[k];
  }
}

HitCover::Voxel& HitCover::find(std::int32_t word, std::int32_t bit) {
  // Neighbours differ in low bits of either, so that few share a place.
  constexpr std::uint32_t kSpread = 0x9E3779B1u;  // 2^32 divided by the golden ratio
  const std::size_t last = table_.size() - 1;
  const std::uint32_t hash = (static_cast<std::uint32_t>(word) * kWordBits + bit) * kSpread;
  for (std::size_t i = (hash >> 8) & last;; i = (i + 1) & last) {
    if (table_[i] == kNoVoxel) {
      table_[i] = static_cast<std::int32_t>(voxels_.size());
      voxels_.push_back({word, bit, 0});
    }
    Voxel& voxel = voxels_[table_[i]];
    if (voxel.word == word && voxel.bit == bit) return voxel;
  }
}

}  // namespace fiimap
