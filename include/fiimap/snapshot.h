#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "fiimap/sliding_grid.h"
#include "fiimap/structuring_element.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// What is known of a voxel. Outside: not in the window. What counts as an obstacle is the caller's
/// choice.
enum class Occupancy : std::uint8_t { kUnknown, kFree, kOccupied, kOutside };

/// The same for the inflated layer; a voxel that is inflated is not reported as unknown or free.
enum class Inflation : std::uint8_t { kUnknown, kFree, kInflated, kOutside };

/// A layer of the map: obstacles inflated, or as measured.
enum class MapLayer { kInflated, kRaw };

/// What a voxel is taken for about which the map says nothing.
enum class Unseen { kObstacle, kFree };

/// What counts as an obstacle: what is inflated (or occupied, of the raw layer) always, the rest by
/// the caller's choice.
struct ObstacleRules {
  MapLayer layer;  ///< that is asked
  Unseen unknown;  ///< in the window
  Unseen outside;  ///< of the window
};

/// Where a segment first meets an obstacle.
struct RayHit {
  VoxelIndex voxel;         ///< of the obstacle
  Eigen::Vector3d point_W;  ///< where the segment enters it, metres, map frame
  double distance;          ///< from the segment's start to there, m; 0: it starts in the obstacle
};

/// Heights beyond which queries see an obstacle whatever was measured, metres in the map frame.
struct VirtualWalls {
  double floor = -std::numeric_limits<double>::infinity();   ///< m
  double ceiling = std::numeric_limits<double>::infinity();  ///< m
};

/// Voxels that follow each other along z.
struct VoxelRun {
  VoxelIndex first;  ///< the lowest
  int count;         ///< >= 1
};

/// An immutable view of the whole map at one moment: window, cells, stamp and sequence number
/// belong together. Reading takes no lock, from any number of threads; it stays valid as long as
/// someone holds it, even after the mapper is gone.
class Snapshot {
 public:
  /// What the snapshot is of.
  struct Info {
    std::int64_t stamp_ns = 0;   ///< of the newest scan in it
    std::uint64_t sequence = 0;  ///< 1, 2, 3, ... of one mapper; a reset does not restart it
    double resolution = 0.0;     ///< m
    VoxelBox window;             ///< what the map covers
    ElementShape inflation_shape = ElementShape::kBall;  ///< see StructuringElement
    double inflation_radius = 0.0;                       ///< m
    VirtualWalls walls;                                  ///< infinitely far where there are none
  };

  /// Shares the tiles of the grid as they are now.
  Snapshot(SlidingGrid* grid, const Info& info);

  /// As given to the constructor.
  const Info& info() const { return info_; }
  /// Turns points into voxels and back.
  const VoxelLattice& lattice() const { return lattice_; }
  /// Voxels that the map covers.
  const VoxelBox& window() const { return info_.window; }

  ///@{
  /// State of a voxel or of the voxel at a point (metres, map frame). A voxel whose centre, or a
  /// point which, lies beyond a virtual wall is occupied and inflated, if it is in the window.
  /// Points that are not finite are outside.
  Occupancy occupancy(const VoxelIndex& v) const;
  Occupancy occupancy(const Eigen::Vector3d& point_W) const;
  Inflation inflation(const VoxelIndex& v) const;
  Inflation inflation(const Eigen::Vector3d& point_W) const;
  ///@}

  /// Whether a voxel counts as an obstacle.
  bool isObstacle(const VoxelIndex& v, const ObstacleRules& rules) const;

  /// First obstacle among the voxels that a segment passes (forEachVoxelOnLine defines them), each
  /// with its own state, so that virtual walls count for whole voxels; nothing when there is none.
  /// Takes time in proportion to the voxels up to the obstacle, in the window or not.
  /// \param from_W, to_W metres, map frame. A segment of which an end has no voxel index, for
  /// instance NaN, is blocked at its start by a voxel outside of the window, whatever the rules.
  std::optional<RayHit> castRay(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                const ObstacleRules& rules) const;
  /// Whether a segment meets no obstacle; the same from either end.
  bool lineOfSight(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W,
                   const ObstacleRules& rules) const;

  /// Measured voxels (virtual walls add none) of a plane inside a box, sorted by x, then y.
  std::vector<VoxelIndex> voxels(Plane plane, const VoxelBox& box) const;
  /// Voxels of the window that are set in one of two snapshots only, sorted by x, then y, then z;
  /// what lies outside of a snapshot's window is not set in it. Where both share a tile it costs no
  /// time, so that cost follows change.
  /// \param before of the same mapper, in any order of time; null: one without any voxel.
  std::vector<VoxelRun> changes(Plane plane, const Snapshot* before) const;
  /// Number of set voxels of a plane in the whole window.
  std::int64_t count(Plane plane) const { return counts_[static_cast<int>(plane)]; }

 private:
  /// A tile that differs between two snapshots; null where nothing was ever seen.
  struct ChangedTile {
    int first_y, end_y;  // its columns in the window
    const std::uint64_t *then, *now;
  };

  /// The tile that holds column (x, y), or null where nothing was ever seen.
  const std::uint64_t* tileAt(int x, int y) const { return tiles_[ring_.slotOf(x, y)].get(); }
  /// Whether columns of the tile that begins at a column lie in the window.
  bool touches(int tile_x, int tile_y) const {
    return tile_x < window().max.x() && tile_x + kTileSide > window().min.x() &&
           tile_y < window().max.y() && tile_y + kTileSide > window().min.y();
  }
  bool test(const std::uint64_t* tile, Plane plane, const VoxelIndex& v) const;
  bool beyondWalls(double z) const { return z < info_.walls.floor || z > info_.walls.ceiling; }
  std::vector<ChangedTile> changedTiles(int tile_x, const Snapshot* before) const;
  void appendChanges(Plane plane, const VoxelBox& kept, int x, const ChangedTile& tile,
                     std::vector<VoxelRun>* runs) const;
  Occupancy measuredOccupancy(const VoxelIndex& v) const;
  Inflation measuredInflation(const VoxelIndex& v) const;

  Info info_;
  VoxelLattice lattice_;
  VoxelBounds bounds_;  // the window
  ColumnLayout layout_;
  TileRing ring_;
  std::vector<std::shared_ptr<const Tile>> tiles_;
  std::int64_t counts_[kPlaneCount];
};

}  // namespace fiimap
