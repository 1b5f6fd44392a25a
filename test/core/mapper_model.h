#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/mapper.h"
#include "oracle.h"
#include "ray_oracle.h"

namespace fiimap::test {

/// The whole map by its definition: rays, log-odds, window and inflation, one voxel at a time.
/// Where the window goes is not modelled: it is taken from the mapper under test.
class MapperModel {
 public:
  explicit MapperModel(const MapperConfig& config) : config_(config), log_odds_(config) {}

  /// Of points (world) seen in one scan, those whose rays leave nothing for rounding to decide when
  /// they are the scan.
  std::vector<bool> exactRays(const ScanPose& pose, const std::vector<Eigen::Vector3d>& points_W,
                              const VoxelBox& window) const {
    const VoxelBox box = updateBox(pose, window);
    std::vector<bool> is_exact(points_W.size(), true);
    if (box.empty()) return is_exact;
    const Eigen::Vector3d origin_W = pose.T_W_S.translation();
    const ExactPoint origin = inVoxels(origin_W);
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      RayOracle alone(box, config_.ray_end_cut, config_.round_rays);
      is_exact[i] = addRay(origin_W, points_W[i], &alone) && alone.halfSideOfCube(origin);
    }
    // What is left out may have been what the cube is as large as.
    for (bool again = true; again;) {
      again = false;
      RayOracle together(box, config_.ray_end_cut, config_.round_rays);
      for (std::size_t i = 0; i < points_W.size(); ++i) {
        if (is_exact[i]) addRay(origin_W, points_W[i], &together);
      }
      for (std::size_t i = 0; i < points_W.size(); ++i) {
        if (!is_exact[i]) continue;
        RayOracle alone(box, config_.ray_end_cut, config_.round_rays);
        addRay(origin_W, points_W[i], &alone);
        alone.cast(origin, *together.halfSideOfCube(origin));
        if (alone.isExact()) continue;
        is_exact[i] = false;
        again = true;
      }
    }
    return is_exact;
  }

  /// \param points_W whose rays are exact.
  /// \param window of the mapper after the scan.
  void integrate(const ScanPose& pose, const std::vector<Eigen::Vector3d>& points_W,
                 const VoxelBox& window) {
    forgetOutside(window);
    lowered_ = raised_ = 0;
    tick(pose.stamp_ns);
    const VoxelBox box = updateBox(pose, window);
    if (box.empty()) return;
    RayOracle oracle(box, config_.ray_end_cut, config_.round_rays);
    for (const Eigen::Vector3d& p : points_W) addRay(pose.T_W_S.translation(), p, &oracle);
    const ExactPoint origin = inVoxels(pose.T_W_S.translation());
    oracle.cast(origin, *oracle.halfSideOfCube(origin));
    forEachVoxel(box, [&](const VoxelIndex& v) {
      const bool is_hit = oracle.hits().count(v) != 0;
      if (is_hit || oracle.mustBeFree(v)) observe(v, is_hit);
    });
  }

  /// \return voxels of the boxes in the window.
  std::int64_t overwrite(const std::vector<VoxelBox>& boxes, Occupancy state,
                         const VoxelBox& window) {
    std::int64_t voxels = 0;
    for (const VoxelBox& box : boxes) {
      forEachVoxel(box, [&](const VoxelIndex& v) {
        if (!window.contains(v)) return;
        ++voxels;
        forget(v);
        if (state == Occupancy::kUnknown) return;
        values_[v] = state == Occupancy::kOccupied ? log_odds_.max : log_odds_.min;
        seen_[v] = {clock_, clock_};
      });
    }
    return voxels;
  }

  void reset() {
    values_.clear();
    seen_.clear();
    newest_stamp_.reset();
  }

  /// Which voxels decay forgets is decided by whose turn it is: that is taken from the grid, within
  /// the limits that hold for each voxel. Call after integrate().
  ::testing::AssertionResult decay(const SlidingGrid& grid) {
    const std::int64_t time = decayTime();
    for (const auto& [v, seen] : std::map<VoxelIndex, Seen, VoxelLess>(seen_)) {
      const bool is_kept = grid.test(Plane::kKnown, v);
      const bool may_go = time > 0 && clock_ > seen.not_before + time;
      const bool must_go = time > 0 && clock_ >= seen.at + 2 * time;
      if (is_kept ? must_go : !may_go) {
        return ::testing::AssertionFailure()
               << v.transpose() << (is_kept ? " is kept " : " is forgotten ") << clock_ - seen.at
               << " ns after it was seen, decay time " << time << " ns";
      }
      if (is_kept) continue;
      if (values_.at(v) >= log_odds_.threshold) ++raised_;
      forget(v);
    }
    return ::testing::AssertionSuccess();
  }

  /// Voxels keep their log-odds to the nearest step, of two that are as near the one farther from
  /// 0, within the limits.
  void reconfigure(const MapperConfig& config) {
    const LogOdds before = log_odds_;
    if (config.decay_time != config_.decay_time) {
      for (auto& [v, seen] : seen_) seen = {clock_, clock_};
    }
    config_ = config;
    log_odds_ = LogOdds(config);
    for (auto& [v, value] : values_) value = nearestStep(value * before.unit);
  }

  std::size_t lowered() const { return lowered_; }
  std::size_t raised() const { return raised_; }
  std::size_t forgotten() const { return forgotten_; }

  VoxelSet occupied() const {
    VoxelSet occupied;
    for (const auto& [v, value] : values_) {
      if (value >= log_odds_.threshold) occupied.insert(v);
    }
    return occupied;
  }

  /// Every voxel of every plane.
  ::testing::AssertionResult equals(const SlidingGrid& grid,
                                    const ElementDefinition& element) const {
    VoxelField known(grid.window()), occupied(grid.window());
    for (const auto& entry : values_) known.mark(entry.first);
    for (const VoxelIndex& v : this->occupied()) occupied.mark(v);
    ::testing::AssertionResult result = planeEquals(grid, Plane::kKnown, known);
    if (!result) return result << " (known)";
    result = planeEquals(grid, Plane::kOccupied, occupied);
    if (!result) return result << " (occupied)";
    result = planeEquals(grid, Plane::kInflated,
                         dilate(this->occupied(), element.offsets(), grid.window()));
    return result ? result : result << " (inflated)";
  }

 private:
  /// When a scan last saw a voxel: at a time of clock_, or at any later than that of the scan
  /// before.
  struct Seen {
    std::int64_t not_before, at;
  };

  std::int64_t decayTime() const { return std::llround(config_.decay_time * 1e9); }

  /// A gap between two scans counts as one decay time at most.
  void tick(std::int64_t stamp) {
    before_ = clock_;
    if (newest_stamp_ && stamp > *newest_stamp_) {
      clock_ += std::min(stamp - *newest_stamp_, decayTime());
    }
    newest_stamp_ = std::max(stamp, newest_stamp_.value_or(stamp));
  }

  VoxelBox updateBox(const ScanPose& pose, const VoxelBox& window) const {
    const VoxelLattice lattice(config_.resolution);
    const VoxelIndex size = lattice.sizeOf(config_.localUpdateRange());
    return VoxelLattice::boxAround(lattice.indexOf(pose.vehicle_W), size).intersection(window);
  }

  bool addRay(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& point_W,
              RayOracle* oracle) const {
    const Eigen::Vector3d ray = point_W - origin_W;
    const double length = ray.norm();
    const bool is_near_a_limit = std::abs(length - config_.min_ray_length) < 1e-4 ||
                                 std::abs(length - config_.max_ray_length) < 1e-4;
    if (is_near_a_limit) return false;
    if (length < config_.min_ray_length) return true;
    const ExactPoint from = inVoxels(origin_W);
    if (length < config_.max_ray_length) return oracle->addReturn(from, inVoxels(point_W));
    if (config_.beyond_max_depth == ReadingPolicy::kIgnore) return true;
    const double cut = config_.ray_end_cut * config_.resolution;
    const double free_length = std::min(config_.max_ray_length, length - cut);
    if (free_length < 1e-4) return free_length < -1e-4;
    return oracle->addMiss(from, inVoxels(origin_W + ray * (free_length / length)));
  }

  ExactPoint inVoxels(const Eigen::Vector3d& point_W) const {
    return point_W.cast<long double>() / static_cast<long double>(config_.resolution);
  }

  void observe(const VoxelIndex& v, bool is_hit) {
    seen_[v] = {before_, clock_};
    int& value = values_[v];
    const bool before = value >= log_odds_.threshold;
    value = std::clamp<int>(value + (is_hit ? log_odds_.hit : log_odds_.miss), log_odds_.min,
                            log_odds_.max);
    const bool after = value >= log_odds_.threshold;
    if (after && !before) ++lowered_;
    if (before && !after) ++raised_;
  }

  int nearestStep(double log_odds) const {
    const auto error = [&](int step) { return std::abs(step * log_odds_.unit - log_odds); };
    int nearest = 0;
    for (const int sign : {-1, 1}) {
      for (int step = 0; step >= log_odds_.min && step <= log_odds_.max; step += sign) {
        if (error(step) <= error(nearest)) nearest = step;
      }
    }
    return nearest;
  }

  void forgetOutside(const VoxelBox& window) {
    forgotten_ = 0;
    for (const auto& [v, value] : std::map<VoxelIndex, int, VoxelLess>(values_)) {
      if (window.contains(v)) continue;
      if (value >= log_odds_.threshold) ++forgotten_;
      forget(v);
    }
  }

  void forget(const VoxelIndex& v) {
    values_.erase(v);
    seen_.erase(v);
  }

  MapperConfig config_;
  LogOdds log_odds_;
  std::map<VoxelIndex, int, VoxelLess> values_;
  std::map<VoxelIndex, Seen, VoxelLess> seen_;
  std::optional<std::int64_t> newest_stamp_;
  std::int64_t clock_ = 0, before_ = 0;  // ns, at the newest scan and the one before it
  std::size_t lowered_ = 0, raised_ = 0, forgotten_ = 0;
};

}  // namespace fiimap::test
