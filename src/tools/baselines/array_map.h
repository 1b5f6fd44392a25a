#pragma once

#include <cstdint>
#include <vector>

#include "array_layout.h"
#include "batch_inflation.h"
#include "mapping_method.h"
#include "pixel_points.h"

namespace fiimap::bench {

/// What the array baselines share: log-odds in double precision and inflated bytes over a box that
/// does not move, per-pixel projection, log-odds added once per voxel and frame, batch inflation of
/// the update box. How rays are cast is up to the derived class.
class ArrayMap : public MappingMethod {
 public:
  /// \param box of voxels that the map covers, the update boxes of all frames included.
  ArrayMap(const MapperConfig& config, const VoxelBox& box);

  void integrate(const Frame& frame) final;
  std::vector<VoxelIndex> occupied(const VoxelBox& box) const final;

 protected:
  /// Collects the observations of one ray with observe().
  /// \param origin of the rays, \param end of the ray in voxel units, inside the update box.
  virtual void castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                       bool is_return) = 0;
  /// Whether the voxel's observations of one frame make it a hit.
  virtual bool isHit(std::uint16_t hits, std::uint16_t observations) const = 0;

  void observe(const VoxelIndex& v, bool hit);
  const MapperConfig& config() const { return config_; }
  const ArrayLayout& layout() const { return layout_; }
  /// Number of the frame, from 1: marks of earlier frames need no clearing. A recording has fewer
  /// than 65536 frames, and small marks are what the original has.
  std::uint16_t frame() const { return frame_; }

 private:
  void applyObservations();
  bool isOccupied(std::size_t index) const { return log_odds_[index] >= threshold_; }

  MapperConfig config_;
  VoxelLattice lattice_;
  ArrayLayout layout_;
  double hit_, miss_, min_, max_, threshold_;  // log-odds
  std::vector<double> log_odds_;
  std::vector<std::uint8_t> inflated_;
  std::vector<std::uint16_t> hits_;  // saturate
  std::vector<std::uint16_t> observations_;
  std::vector<std::size_t> observed_;  // of this frame
  std::vector<PixelPoint> points_;
  BatchInflation inflation_;
  std::uint16_t frame_ = 0;
};

}  // namespace fiimap::bench
