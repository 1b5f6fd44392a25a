#include "seen_surface.h"

namespace fiimap {
namespace {

/// Floors and walls often lie on the boundary of two cells: how far behind the surface its cell is
/// looked up, so that rounding does not spread one surface over both, m.
constexpr double kBehindSurface = 1e-3;

}  // namespace

void SeenSurface::add(const RangeData& scan, double time) {
  ++scan_;
  for (const Eigen::Vector3f& end : scan.returns) {
    const Eigen::Vector3d direction_W = end.cast<double>().normalized();
    const ExactScene::Hit hit = scene_->firstHit(scan.origin, direction_W, time);
    if (hit.distance > max_range_ || !hit.shape->alwaysThere()) continue;
    const double distance = hit.distance + kBehindSurface;
    const VoxelIndex v = lattice_.indexOf(scan.origin + distance * direction_W);
    const auto [found, is_new] = cells_.try_emplace({v.x(), v.y(), v.z()});
    Cell& cell = found->second;
    if (is_new) cell.passing = scene_->distanceToPassing(lattice_.centerOf(v)) < kPassingMargin;
    if (cell.last_scan != scan_) ++cell.scans;
    cell.last_scan = scan_;
  }
}

}  // namespace fiimap
