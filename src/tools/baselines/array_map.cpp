#include "array_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fiimap::bench {
namespace {

constexpr std::uint16_t kMaxCount = std::numeric_limits<std::uint16_t>::max();

double logOdds(double p) { return std::log(p / (1.0 - p)); }

}  // namespace

ArrayMap::ArrayMap(const MapperConfig& config, const VoxelBox& box)
    : config_(config),
      lattice_(config.resolution),
      layout_(box),
      hit_(logOdds(config.p_hit)),
      miss_(logOdds(config.p_miss)),
      min_(logOdds(config.p_min)),
      max_(logOdds(config.p_max)),
      threshold_(logOdds(config.p_occ)),
      log_odds_(layout_.voxels(), 0.0),
      inflated_(layout_.voxels(), 0),
      hits_(layout_.voxels(), 0),
      observations_(layout_.voxels(), 0),
      inflation_(config.structuringElement(), layout_) {}

void ArrayMap::integrate(const Frame& frame) {
  ++frame_;
  projectPixels(frame, config_, &points_);
  const VoxelBox box = updateBox(config_, frame.pose);
  const Eigen::Vector3d origin = frame.pose.T_W_S.translation() / config_.resolution;
  for (const PixelPoint& point : points_) {
    Eigen::Vector3d end = point.end_W / config_.resolution;
    bool is_return = point.is_return;
    if (clipToBox(origin, box, &end, &is_return)) castRay(origin, end, is_return);
  }
  applyObservations();
  inflation_.inflate(
      box, [this](std::size_t index) { return isOccupied(index); }, &inflated_);
}

void ArrayMap::observe(const VoxelIndex& v, bool hit) {
  const std::size_t index = layout_.indexOf(v);
  if (observations_[index] == 0) observed_.push_back(index);
  if (observations_[index] < kMaxCount) ++observations_[index];
  if (hit && hits_[index] < kMaxCount) ++hits_[index];
}

void ArrayMap::applyObservations() {
  for (const std::size_t index : observed_) {
    const double change = isHit(hits_[index], observations_[index]) ? hit_ : miss_;
    log_odds_[index] = std::clamp(log_odds_[index] + change, min_, max_);
    hits_[index] = 0;
    observations_[index] = 0;
  }
  observed_.clear();
}

std::vector<VoxelIndex> ArrayMap::occupied(const VoxelBox& box) const {
  std::vector<VoxelIndex> found;
  const VoxelBox inside = box.intersection(layout_.box());
  for (int x = inside.min.x(); x < inside.max.x(); ++x) {
    for (int y = inside.min.y(); y < inside.max.y(); ++y) {
      for (int z = inside.min.z(); z < inside.max.z(); ++z) {
        if (isOccupied(layout_.indexOf(x, y, z))) found.emplace_back(x, y, z);
      }
    }
  }
  return found;
}

}  // namespace fiimap::bench
