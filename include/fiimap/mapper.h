#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "fiimap/change_set.h"
#include "fiimap/decay.h"
#include "fiimap/depth_projector.h"
#include "fiimap/ignored_volumes.h"
#include "fiimap/inflater.h"
#include "fiimap/log_odds.h"
#include "fiimap/mapper_config.h"
#include "fiimap/point_projector.h"
#include "fiimap/range_data.h"
#include "fiimap/ray_caster.h"
#include "fiimap/scan_integrator.h"
#include "fiimap/scan_mask.h"
#include "fiimap/sliding_grid.h"
#include "fiimap/snapshot.h"

/// Occupancy mapping. What is not under fiimap/ros/ knows no ROS.
namespace fiimap {

/// Where a scan was taken.
struct ScanPose {
  /// Sensor to world. Cameras: optical frame.
  Eigen::Isometry3d T_W_S = Eigen::Isometry3d::Identity();
  /// Position of the vehicle in the world, metres: the window and the update range follow it.
  Eigen::Vector3d vehicle_W = Eigen::Vector3d::Zero();
  /// Orientation of the vehicle, body to world: only body_size_x/y/z ask for it.
  Eigen::Matrix3d R_W_B = Eigen::Matrix3d::Identity();
  /// Of the scan, nanoseconds.
  std::int64_t stamp_ns = 0;

  /// The vehicle's body to world.
  Eigen::Isometry3d T_W_B() const;
};

/// Wall-clock time of each stage of one update, milliseconds. The snapshot is made on demand, so
/// its time is filled in by who asks for it.
struct StageTimes {
  ///@{
  /// Stage of Mapper::integrate(), in this order; the last is Mapper::snapshot().
  double project = 0.0, slide = 0.0, raycast = 0.0, fuse = 0.0, inflate = 0.0, snapshot = 0.0;
  ///@}
  /// All of them.
  double total() const { return project + slide + raycast + fuse + inflate + snapshot; }
};

/// What one scan did.
struct ScanReport {
  ReadingCount readings;      ///< of the sensor, by kind
  RayCount rays;              ///< distinct ones that were cast
  std::size_t raise = 0;      ///< voxels that ceased to be occupied; see ChangeSet
  std::size_t lower = 0;      ///< voxels that became occupied
  std::size_t forgotten = 0;  ///< occupied voxels that the window left behind
  VoxelBox update_box;        ///< voxels that its rays could change
  StageTimes times_ms;        ///< but for the snapshot

  /// The paper's: see ChangeSet::score().
  std::size_t changeScore() const { return raise + lower; }
};

/// The map: scans of one sensor or several in, snapshots out.
/// Not thread-safe: one thread owns it; other threads read the snapshots.
class Mapper {
 public:
  /// \throws std::invalid_argument when the configuration is not valid.
  explicit Mapper(const MapperConfig& config);

  /// Integrates one scan. The window follows it unless a newer one is in the map already.
  /// \param sensor that it is from: index into the configuration's `sensors`.
  /// \throws std::invalid_argument, with the map unchanged, when the pose is not finite or not in
  /// the range of voxel indices, or the image or its intrinsics are not valid; std::out_of_range
  /// for a sensor that there is not.
  ScanReport integrate(const DepthImage& image, const PinholeIntrinsics& intrinsics,
                       const ScanPose& pose, std::size_t sensor = 0);
  /// The same of points.
  ScanReport integrate(const PointScan& points, const ScanPose& pose, std::size_t sensor = 0);

  /// An immutable view of the map as it is now, with the stamp of the newest scan.
  std::shared_ptr<const Snapshot> snapshot();

  /// Forgets everything; stamps may begin again.
  void reset();

  /// Goes on with another configuration. Scans from now on are integrated as a mapper would that
  /// was made with it; what is in the map stays, each voxel's probability rounded to the nearest
  /// step of the new LogOdds and clamped to its limits, and occupied is what reaches the new p_occ.
  /// Both layers are exact on return. Costs what changes; a pass over all that is known when the
  /// probabilities do, or the inflation.
  /// \throws std::invalid_argument, with the map and its configuration unchanged, when the
  /// configuration is not valid, or differs in what is not `tunable` (mapperParameters()) or in the
  /// number of sensors.
  void reconfigure(const MapperConfig& config);

  /// Ignores returns in spheres from now on; see IgnoredVolumes. A reset forgets them.
  void ignore(const std::vector<IgnoredSphere>& spheres) { ignored_.add(spheres); }

  /// Makes all voxels of boxes, as far as they lie in the window, unknown, free or occupied,
  /// whatever was seen of them; the inflated layer is exact again on return. Free and occupied are
  /// as sure as log-odds get, so scans change them as they change what was seen many times. Before
  /// the window is placed, all voxels lie outside of it.
  /// \return how many voxels of the boxes lie in the window; those of several boxes count each
  /// time. \throws std::invalid_argument for the state kOutside.
  std::int64_t overwrite(const std::vector<VoxelBox>& boxes, Occupancy state);

  /// Puts the window where a scan of a vehicle at this position (world, metres) would put it; does
  /// nothing when a scan, or a call like this, has done so since the start or the last reset.
  /// \throws std::invalid_argument for a position that has no voxel index.
  void placeWindow(const Eigen::Vector3d& vehicle_W);
  /// Whether the window has its place: since the first scan or placeWindow().
  bool hasWindow() const { return window_placed_; }

  /// In effect.
  const MapperConfig& config() const { return config_; }
  /// The probabilities of the configuration as the map adds them.
  const LogOdds& logOdds() const { return stages_->integrator.logOdds(); }
  /// For tests, evaluation and statistics.
  const SlidingGrid& grid() const { return grid_; }
  /// Memory of grid and scan now, bytes; without what only snapshots hold.
  std::size_t memoryBytes() const;

 private:
  struct SensorProjectors {
    DepthProjector depth;
    PointProjector points;
  };

  /// What scans pass through: made from a configuration and nothing else.
  struct Stages {
    explicit Stages(const MapperConfig& config);

    std::vector<SensorProjectors> projectors;  // by sensor
    RayCaster ray_caster;
    ScanIntegrator integrator;
    std::unique_ptr<Inflater> inflater;
  };

  ScanReport integrateScan(const ScanPose& pose, ScanReport report);
  void follow(const VoxelIndex& vehicle);

  MapperConfig config_;
  VoxelLattice lattice_;
  SlidingGrid grid_;
  std::unique_ptr<Stages> stages_;
  IgnoredVolumes ignored_;
  Decay decay_;

  RangeData scan_;
  ScanMask mask_;
  ChangeSet changes_;
  bool window_placed_ = false;
  std::int64_t stamp_ns_ = 0;  // of the newest scan
  std::uint64_t sequence_ = 0;
};

}  // namespace fiimap
