#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "fiimap/range_data.h"
#include "fiimap/scan_mask.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// A ball in which returns are ignored for a while: another vehicle.
struct IgnoredSphere {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();  ///< m
  double radius = 0.0;                                 ///< m
  std::int64_t stamp_ns = 0;                           ///< when it was there
  /// It counts for scans whose stamps are at most so far from its own, before or after.
  std::int64_t lifetime_ns = 0;

  /// Whether it counts for a scan of this stamp.
  bool countsAt(std::int64_t stamp_ns) const;
};

/// Places where returns say nothing of the world: the vehicle's own body, and spheres. A return in
/// one of them, borders included, is as if its reading had not been made: nothing is hit, and
/// nothing is free on the way. Rays through them to somewhere else are rays as all others.
/// Not thread-safe.
class IgnoredVolumes {
 public:
  /// That count at once.
  static constexpr std::size_t kMaxSpheres = 1000;

  /// \param body_size extent of the vehicle around the origin of its body's frame, along the axes
  /// of that frame, metres; 0: it has none.
  explicit IgnoredVolumes(const Eigen::Vector3d& body_size) { setBody(body_size); }

  /// Another body; the spheres stay.
  void setBody(const Eigen::Vector3d& body_size) {
    half_body_ = body_size / 2.0;
    has_body_ = (body_size.array() > 0.0).all();
  }

  /// Adds spheres; those added first give way when there are more than kMaxSpheres.
  void add(const std::vector<IgnoredSphere>& spheres);
  /// The body stays.
  void forgetSpheres() { spheres_.clear(); }

  /// Takes the returns of a scan that lie in a volume away.
  /// \return how many.
  std::size_t removeReturns(const Eigen::Isometry3d& T_W_B, std::int64_t stamp_ns, RangeData* scan);

  /// Marks the voxels whose centres lie in the body's box as free in the mask of a scan: the
  /// vehicle is there, so nothing else is.
  void freeBody(const Eigen::Isometry3d& T_W_B, const VoxelLattice& lattice, ScanMask* mask) const;

 private:
  bool isInBody(const Eigen::Vector3d& point_B) const {
    return (point_B.array().abs() <= half_body_.array()).all();
  }

  Eigen::Vector3d half_body_;
  bool has_body_;
  std::vector<IgnoredSphere> spheres_;
  std::vector<IgnoredSphere> counting_;  // for the scan at hand
};

}  // namespace fiimap
